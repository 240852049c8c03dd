//! Files of raw results.

use std::error::Error;
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use crate::machine::Machine;

/// A table of raw results in `benches/results/`. Its first line, after `#`, tells the machine and the day.
pub struct Results {
    file: csv::Writer<File>,
    path: PathBuf,
}

impl Results {
    /// Begins the table of this name and day. One of the same name and day is replaced.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn create(name: &str, machine: &Machine, columns: &[&str]) -> Result<Self, Box<dyn Error>> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../results");
        std::fs::create_dir_all(&folder)?;
        let path = folder.join(format!("{name}-{}.csv", machine.date));
        let mut file = File::create(&path)?;
        writeln!(file, "# {machine}")?;
        let mut file = csv::Writer::from_writer(file);
        file.write_record(columns)?;
        Ok(Self { file, path })
    }

    /// Adds one row.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn row<T: ToString>(&mut self, fields: impl IntoIterator<Item = T>) -> Result<(), Box<dyn Error>> {
        self.file.write_record(fields.into_iter().map(|field| field.to_string()))?;
        self.file.flush()?;
        Ok(())
    }

    /// The file's name.
    pub fn file_name(&self) -> String {
        self.path.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }
}
