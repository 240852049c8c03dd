//! Runs `iso` in a private folder and tells all about a run that is not as expected.

use std::ffi::OsStr;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Child, Command, Output, Stdio};

use tempfile::TempDir;

/// A folder of its own, in which commands run.
pub(crate) struct Case {
    folder: TempDir,
}

impl Case {
    /// An empty folder.
    pub(crate) fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a temporary folder can be made") }
    }

    /// Writes a file into the folder.
    pub(crate) fn file(&self, name: &str, content: impl AsRef<[u8]>) -> &Self {
        std::fs::write(self.path(name), content).expect("a file can be written");
        self
    }

    /// The path of a name in the folder.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The content of a file of the folder.
    pub(crate) fn content(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name} cannot be read: {error}"))
    }

    /// The names in the folder, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).expect("the folder can be listed");
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Runs `iso` with arguments.
    pub(crate) fn run<A: AsRef<OsStr>>(&self, arguments: &[A]) -> Run {
        self.run_with_input(arguments, b"")
    }

    /// Runs `iso` with arguments and something to read on standard input.
    pub(crate) fn run_with_input<A: AsRef<OsStr>>(&self, arguments: &[A], input: &[u8]) -> Run {
        let mut started = self.start(arguments);
        // A run that fails early does not read its input: that is no error of the test.
        let _ = started.child.stdin.take().expect("standard input is piped").write_all(input);
        started.end()
    }

    /// Runs `iso` with arguments and a standard input that says nothing and has no end.
    pub(crate) fn run_with_endless_input<A: AsRef<OsStr>>(&self, arguments: &[A]) -> Run {
        let mut started = self.start(arguments);
        let input = started.child.stdin.take();
        let run = started.end();
        drop(input);
        run
    }

    /// Starts `iso` with arguments.
    pub(crate) fn start<A: AsRef<OsStr>>(&self, arguments: &[A]) -> Started {
        let mut command = Command::new(env!("CARGO_BIN_EXE_iso"));
        command.args(arguments).current_dir(self.folder.path());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let child = command.spawn().expect("iso can be started");
        Started { command: format!("{command:?}"), child }
    }
}

/// A run that goes on.
pub(crate) struct Started {
    command: String,
    child: Child,
}

impl Started {
    /// Sends the signal of this name; that of Ctrl-C is `INT`.
    #[cfg(unix)]
    pub(crate) fn send(&self, signal: &str) {
        let sent = Command::new("kill").args([&format!("-{signal}"), &self.child.id().to_string()]).status();
        assert!(sent.expect("kill can be started").success(), "{} ended early", self.command);
    }

    /// Waits for the end.
    pub(crate) fn end(self) -> Run {
        let output = self.child.wait_with_output().expect("iso ends");
        Run { command: self.command, output }
    }
}

/// A run that ended.
pub(crate) struct Run {
    command: String,
    output: Output,
}

impl Run {
    /// Expects an exit code.
    #[track_caller]
    pub(crate) fn exits(self, code: i32) -> Self {
        if self.output.status.code() != Some(code) {
            self.fail(&format!("expected the exit code {code}"));
        }
        self
    }

    /// The exit code; `None` when a signal ended the run.
    pub(crate) fn code(&self) -> Option<i32> {
        self.output.status.code()
    }

    /// Standard output, whatever it holds.
    pub(crate) fn bytes(&self) -> &[u8] {
        &self.output.stdout
    }

    /// Standard output.
    pub(crate) fn stdout(&self) -> String {
        String::from_utf8_lossy(&self.output.stdout).into_owned()
    }

    /// Standard error.
    pub(crate) fn stderr(&self) -> String {
        String::from_utf8_lossy(&self.output.stderr).into_owned()
    }

    /// Expects exactly this on standard output.
    #[track_caller]
    pub(crate) fn prints(self, expected: &str) -> Self {
        if self.stdout() != expected {
            self.fail(&format!("expected on standard output:\n{expected}"));
        }
        self
    }

    /// Expects exactly this on standard error.
    #[track_caller]
    pub(crate) fn reports(self, expected: &str) -> Self {
        if self.stderr() != expected {
            self.fail(&format!("expected on standard error:\n{expected}"));
        }
        self
    }

    /// Expects standard error to hold this.
    #[track_caller]
    pub(crate) fn mentions(self, expected: &str) -> Self {
        if !self.stderr().contains(expected) {
            self.fail(&format!("expected on standard error, somewhere:\n{expected}"));
        }
        self
    }

    /// Expects one JSON value on standard output.
    #[track_caller]
    pub(crate) fn json(&self) -> serde_json::Value {
        match serde_json::from_slice(&self.output.stdout) {
            Ok(value) => value,
            Err(error) => self.fail(&format!("expected JSON on standard output: {error}")),
        }
    }

    #[track_caller]
    fn fail(&self, expected: &str) -> ! {
        let mut story = String::new();
        let _ = writeln!(story, "{expected}\n\ncommand: {}\nexit: {}", self.command, self.output.status);
        let _ = writeln!(story, "standard output:\n{}\nstandard error:\n{}", self.stdout(), self.stderr());
        panic!("{story}");
    }
}
