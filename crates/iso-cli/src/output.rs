//! Output files, which appear whole or not at all.

use std::error::Error;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

use crate::failure::Failure;

/// Held while there is a file that is not yet whole.
static UNFINISHED_FILE: Mutex<()> = Mutex::new(());

fn hold_unfinished_file() -> MutexGuard<'static, ()> {
    // A panic while a file was written left nothing to protect.
    UNFINISHED_FILE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends the program, but not before a file that is being written is whole.
pub(crate) fn exit_between_files(code: u8) -> ! {
    let _held = hold_unfinished_file();
    process::exit(code.into())
}

/// Whether a name stands for standard output.
pub(crate) fn is_standard_output(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Where the results of a command go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Destination {
    /// Standard output.
    Standard,
    /// A file.
    File(OutputFile),
}

impl Destination {
    /// Standard output when `path` is missing or `-`.
    pub(crate) fn new(path: Option<PathBuf>) -> Result<Self, Failure> {
        match path {
            Some(path) if !is_standard_output(&path) => OutputFile::new(path).map(Self::File),
            _ => Ok(Self::Standard),
        }
    }

    /// That it does not take the place of a file from which the results are made.
    pub(crate) fn spares(&self, source: &Path) -> Result<(), Failure> {
        match self {
            Self::File(file) => file.spares(source),
            Self::Standard => Ok(()),
        }
    }

    /// Writes what `fill` writes.
    pub(crate) fn write(&self, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
        match self {
            Self::File(file) => file.write(|writer| fill(writer)),
            Self::Standard => to_standard_output(fill),
        }
    }
}

/// Makes a folder, and those in which it lies, unless they are there.
pub(crate) fn make_folder(path: &Path) -> Result<(), Failure> {
    if let Some(file) = path.ancestors().find(|ancestor| ancestor.is_file()) {
        return Err(Failure::usage(format!("{} is a file", file.display()), "name a folder"));
    }
    fs::create_dir_all(path).map_err(|error| Failure::write(path, error))
}

/// Writes what `fill` writes to standard output.
pub(crate) fn to_standard_output(fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    let mut writer = BufWriter::new(io::stdout().lock());
    fill(&mut writer).and_then(|()| writer.flush()).map_err(Failure::StandardOutput)
}

/// A file that can be written, as far as can be known before it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct OutputFile {
    /// As given.
    path: PathBuf,
    place: Place,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Place {
    /// A regular file or none yet, to be replaced; symbolic links are followed.
    Replaced(PathBuf),
    /// A pipe or a device, which must stay where it is.
    Stream,
}

impl OutputFile {
    /// Makes sure that `path` can be written, so that nothing is computed in vain. Leaves no trace there.
    pub(crate) fn new(path: PathBuf) -> Result<Self, Failure> {
        if is_standard_output(&path) {
            return Err(Failure::usage("`-` is standard output, where this cannot go", "name a file"));
        }
        let place = match fs::metadata(&path) {
            Ok(found) if found.is_dir() => {
                let error = io::Error::new(io::ErrorKind::IsADirectory, "it is a directory");
                return Err(Failure::write(&path, error));
            }
            Ok(found) if !found.is_file() => Place::Stream,
            Ok(found) if found.permissions().readonly() => {
                let error = io::Error::new(io::ErrorKind::PermissionDenied, "it may only be read");
                return Err(Failure::write(&path, error));
            }
            Ok(_) => Place::Replaced(path.canonicalize().map_err(|error| Failure::write(&path, error))?),
            Err(_) => Place::Replaced(resolved(&path)),
        };
        if let Place::Replaced(target) = &place {
            let _held = hold_unfinished_file();
            temporary_beside(target).map_err(|error| Failure::write(&path, error))?;
        }
        Ok(Self { path, place })
    }

    /// The path as given.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// That it does not take the place of a file from which the results are made.
    pub(crate) fn spares(&self, source: &Path) -> Result<(), Failure> {
        match &self.place {
            Place::Replaced(target) if source.canonicalize().is_ok_and(|source| source == *target) => {
                let problem =
                    format!("the results would take the place of {}, which is read", source.display());
                Err(Failure::usage(problem, "give the results another name"))
            }
            _ => Ok(()),
        }
    }

    /// Whether what is written to one is lost when the other is written.
    pub(crate) fn is_replaced_by(&self, other: &Self) -> bool {
        matches!(self.place, Place::Replaced(_)) && self.place == other.place
    }

    /// Writes what `fill` writes: to a temporary file beside the target, which then takes its place.
    pub(crate) fn write<E>(
        &self,
        fill: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>,
    ) -> Result<(), Failure>
    where
        E: Into<Box<dyn Error + Send + Sync>>,
    {
        let unwritable = |error: io::Error| Failure::write(&self.path, error);
        let filled = |file: File| {
            let mut writer = BufWriter::new(file);
            fill(&mut writer).map_err(|error| Failure::write(&self.path, error))?;
            writer.flush().map_err(unwritable)
        };
        match &self.place {
            Place::Stream => filled(File::create(&self.path).map_err(unwritable)?),
            Place::Replaced(target) => {
                let _held = hold_unfinished_file();
                let temporary = temporary_beside(target).map_err(unwritable)?;
                if let Ok(before) = fs::metadata(target) {
                    temporary.as_file().set_permissions(before.permissions()).map_err(unwritable)?;
                }
                filled(temporary.reopen().map_err(unwritable)?)?;
                temporary.persist(target).map_err(|error| unwritable(error.error))?;
                Ok(())
            }
        }
    }
}

/// The path of a file that is none yet, so that it is the same however it is written. As given where its folder is not found.
fn resolved(path: &Path) -> PathBuf {
    let folder = folder_of(path).canonicalize();
    match (folder, path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    }
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

fn temporary_beside(target: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".iso-");
    // Temporary files are private by default; a result is as readable as any file that the user creates.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder_of(target)).map_err(without_temporary_name)
}

/// The error of a temporary file, whose name is nobody's concern.
fn without_temporary_name(error: io::Error) -> io::Error {
    let text = error.to_string();
    let cause = text.split(" at path ").next().unwrap_or_default();
    io::Error::new(error.kind(), cause.to_owned())
}

#[cfg(test)]
mod tests {
    use tempfile::TempDir;

    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    fn folder_with_a_file() -> (TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.csv");
        fs::write(&path, "before").unwrap();
        (folder, path)
    }

    #[test]
    fn a_file_is_replaced_whole() {
        let (folder, path) = folder_with_a_file();
        let file = OutputFile::new(path.clone()).unwrap();
        file.write(|writer| write!(writer, "after")).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "after");
        assert_eq!(names(folder.path()), ["out.csv"]);
    }

    #[test]
    fn a_failure_leaves_what_was_there() {
        let (folder, path) = folder_with_a_file();
        let file = OutputFile::new(path.clone()).unwrap();
        let result = file.write(|writer| {
            write!(writer, "half of it")?;
            Err(io::Error::other("no more"))
        });
        assert!(result.is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "before");
        assert_eq!(names(folder.path()), ["out.csv"]);
    }

    #[test]
    fn places_that_cannot_be_written_are_known_before() {
        let folder = tempfile::tempdir().unwrap();
        assert!(OutputFile::new(folder.path().to_owned()).is_err());
        assert!(OutputFile::new(folder.path().join("missing/out.csv")).is_err());
        assert!(OutputFile::new(folder.path().join("out.csv")).is_ok());
        assert!(names(folder.path()).is_empty());
    }

    #[test]
    fn files_that_may_only_be_read_or_are_read_stay() {
        let (folder, path) = folder_with_a_file();
        let file = OutputFile::new(path.clone()).unwrap();
        assert!(file.spares(&folder.path().join("../").join(folder.path()).join("out.csv")).is_err());
        assert!(file.spares(&folder.path().join("in.csv")).is_ok());
        let mut permissions = fs::metadata(&path).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&path, permissions).unwrap();
        let error = OutputFile::new(path.clone()).unwrap_err();
        assert!(error.to_string().ends_with("it may only be read"), "{error}");
        assert_eq!(fs::read_to_string(&path).unwrap(), "before");
    }

    #[cfg(unix)]
    #[test]
    fn a_file_keeps_its_permissions() {
        use std::os::unix::fs::PermissionsExt;
        let (_folder, path) = folder_with_a_file();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).unwrap();
        OutputFile::new(path.clone()).unwrap().write(|writer| write!(writer, "after")).unwrap();
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o600);
    }

    #[cfg(unix)]
    #[test]
    fn devices_and_links_stay() {
        let folder = tempfile::tempdir().unwrap();
        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        fs::write(&target, "").unwrap();
        std::os::unix::fs::symlink(&target, &link).unwrap();
        OutputFile::new(link.clone()).unwrap().write(|writer| write!(writer, "text")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&target).unwrap(), "text");
        OutputFile::new("/dev/null".into()).unwrap().write(|writer| write!(writer, "text")).unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}
