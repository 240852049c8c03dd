//! Files of raw results.

use std::error::Error;
use std::fs::File;
use std::path::{Path, PathBuf};

use crate::machine::Machine;

/// A table of raw results in `benches/results/`. Each row begins with the date, the processor and its cores.
pub struct Results {
    file: csv::Writer<File>,
    path: PathBuf,
    machine: [String; 3],
}

impl Results {
    /// Begins the table of this name and day. One of the same name and day is replaced.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn create(name: &str, machine: &Machine, columns: &[&str]) -> Result<Self, Box<dyn Error>> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../results").canonicalize()?;
        let path = folder.join(format!("{name}-{}.csv", machine.date));
        let mut file = csv::Writer::from_path(&path)?;
        file.write_record(["date", "processor", "cores"].iter().chain(columns))?;
        let machine = [machine.date.clone(), machine.processor.clone(), machine.cores.to_string()];
        Ok(Self { file, path, machine })
    }

    /// Adds one row.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn row<T: ToString>(&mut self, fields: impl IntoIterator<Item = T>) -> Result<(), Box<dyn Error>> {
        let fields = fields.into_iter().map(|field| field.to_string());
        self.file.write_record(self.machine.iter().cloned().chain(fields))?;
        self.file.flush()?;
        Ok(())
    }

    /// The file's name.
    pub fn file_name(&self) -> String {
        self.path.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }
}
