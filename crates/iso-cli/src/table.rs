//! Tables of numbers as comma-separated values: points, boxes and rays in, results out.
//!
//! The first line names the columns, whose order is free, and every other line is a row. Columns that nobody asks for are
//! ignored, and so are empty lines and lines that begin with `#`.

#[cfg(test)]
mod property;

use std::fmt::{self, Display, Formatter, LowerExp};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a table could not be read, and where.
#[derive(Debug, Error)]
#[error("{}:{line}: {problem}", path.display())]
pub(crate) struct TableError {
    path: PathBuf,
    line: u64,
    problem: Problem,
}

#[derive(Debug, Error)]
enum Problem {
    #[error("cannot be read: {0}")]
    Unreadable(io::Error),
    #[error("expected a first line that names the columns {expected}, but the file is empty")]
    NoHeader { expected: String },
    #[error("there is no column `{column}`; the columns are {found}")]
    NoColumn { column: String, found: String },
    #[error("there are several columns `{column}`")]
    RepeatedColumn { column: String },
    #[error("column `{column}` is missing, for the row has only {given} of {expected} columns")]
    ShortRow { column: String, given: usize, expected: usize },
    #[error("the row has {given} fields, but there are {expected} columns; numbers have points, not commas")]
    LongRow { given: usize, expected: usize },
    #[error("column `{column}`: expected a number, found `{given}`")]
    NotANumber { column: String, given: String },
    #[error("the line is longer than {LONGEST_LINE} bytes")]
    LongLine,
    #[error("the rows up to here are all that this machine's memory holds")]
    TooLarge,
    #[error("{0}")]
    Meaningless(String),
}

/// The wanted columns of a table.
#[derive(Debug)]
pub(crate) struct Table<const N: usize> {
    /// The numbers, column by column.
    pub(crate) columns: [Vec<f64>; N],
    path: PathBuf,
    lines: Vec<u64>,
}

impl<const N: usize> Table<N> {
    /// The number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.lines.len()
    }

    /// The numbers of a row.
    pub(crate) fn row(&self, row: usize) -> [f64; N] {
        self.columns.each_ref().map(|column| column[row])
    }

    /// The numbers of a row make no sense together.
    pub(crate) fn meaningless(&self, row: usize, problem: impl Into<String>) -> TableError {
        TableError {
            path: self.path.clone(),
            line: self.lines[row],
            problem: Problem::Meaningless(problem.into()),
        }
    }
}

/// Reads the columns called `names` of the file at `path` (`-` is standard input).
pub(crate) fn read<const N: usize>(path: &Path, names: [&str; N]) -> Result<Table<N>, TableError> {
    if path.as_os_str() == "-" {
        return read_from(io::stdin().lock(), path, names);
    }
    match File::open(path) {
        Ok(file) => read_from(BufReader::new(file), path, names),
        Err(error) => Err(TableError { path: path.to_owned(), line: 1, problem: Problem::Unreadable(error) }),
    }
}

/// Reads the columns called `names` of a text; `path` is what errors call it.
pub(crate) fn read_from<const N: usize>(
    source: impl BufRead,
    path: &Path,
    names: [&str; N],
) -> Result<Table<N>, TableError> {
    let mut table = Table { columns: [const { Vec::new() }; N], path: path.to_owned(), lines: Vec::new() };
    let mut header = None;
    for (line, text) in (1..).zip(lines(source)) {
        let at = |problem| TableError { path: path.to_owned(), line, problem };
        let text = text.map_err(at)?;
        let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&text).trim_ascii();
        if text.is_empty() || text.starts_with(b"#") {
            continue;
        }
        let fields = fields(text);
        let Some(header) = &header else {
            header = Some(Header::find(&fields, names).map_err(at)?);
            continue;
        };
        header.check(&fields).map_err(at)?;
        for (column, values) in table.columns.iter_mut().enumerate() {
            values.try_reserve(1).map_err(|_| at(Problem::TooLarge))?;
            values.push(header.number(&fields, column).map_err(at)?);
        }
        table.lines.try_reserve(1).map_err(|_| at(Problem::TooLarge))?;
        table.lines.push(line);
    }
    match header {
        Some(_) => Ok(table),
        None => {
            let problem = Problem::NoHeader { expected: names.join(",") };
            Err(TableError { path: path.to_owned(), line: 1, problem })
        }
    }
}

/// The longest line, in bytes: far longer than any row, and kept in memory.
const LONGEST_LINE: u64 = 1 << 20;

/// The lines of a text, up to the first that is too long.
fn lines(mut source: impl BufRead) -> impl Iterator<Item = Result<Vec<u8>, Problem>> {
    std::iter::from_fn(move || {
        let mut line = Vec::new();
        match source.by_ref().take(LONGEST_LINE + 1).read_until(b'\n', &mut line) {
            Err(error) => Some(Err(Problem::Unreadable(error))),
            Ok(0) => None,
            Ok(length) if length as u64 > LONGEST_LINE => Some(Err(Problem::LongLine)),
            Ok(_) => Some(Ok(line)),
        }
    })
}

/// What some programs put before the first line.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The fields of a line. A field in quotation marks may hold commas.
fn fields(line: &[u8]) -> Vec<&[u8]> {
    let mut is_quoted = false;
    let is_end = |&byte: &u8| {
        is_quoted ^= byte == b'"';
        byte == b',' && !is_quoted
    };
    line.split(is_end).map(unquoted).collect()
}

fn unquoted(field: &[u8]) -> &[u8] {
    let field = field.trim_ascii();
    field.strip_prefix(b"\"").and_then(|inner| inner.strip_suffix(b"\"")).unwrap_or(field)
}

/// Where the wanted columns stand.
struct Header<'a, const N: usize> {
    names: [&'a str; N],
    places: [usize; N],
    width: usize,
}

impl<'a, const N: usize> Header<'a, N> {
    fn find(fields: &[&[u8]], names: [&'a str; N]) -> Result<Self, Problem> {
        let mut places = [0; N];
        for (place, name) in places.iter_mut().zip(names) {
            let mut found = (0..fields.len()).filter(|&index| fields[index] == name.as_bytes());
            let column = name.to_owned();
            *place = match (found.next(), found.next()) {
                (Some(index), None) => index,
                (Some(_), Some(_)) => return Err(Problem::RepeatedColumn { column }),
                (None, _) => {
                    let found = shown(&fields.join(&b","[..]));
                    return Err(Problem::NoColumn { column, found });
                }
            };
        }
        Ok(Self { names, places, width: fields.len() })
    }

    /// Fields without a column may be empty, as some programs end rows by a comma.
    fn check(&self, fields: &[&[u8]]) -> Result<(), Problem> {
        let without_column = fields.get(self.width..).unwrap_or_default();
        if without_column.iter().all(|field| field.is_empty()) {
            return Ok(());
        }
        Err(Problem::LongRow { given: fields.len(), expected: self.width })
    }

    fn number(&self, fields: &[&[u8]], column: usize) -> Result<f64, Problem> {
        let name = || self.names[column].to_owned();
        let Some(&field) = fields.get(self.places[column]) else {
            return Err(Problem::ShortRow { column: name(), given: fields.len(), expected: self.width });
        };
        let number = std::str::from_utf8(field).ok().and_then(|text| text.parse().ok());
        number.ok_or_else(|| Problem::NotANumber { column: name(), given: shown(field) })
    }
}

/// Text for an error: readable whatever its bytes, and short whatever its length.
fn shown(bytes: &[u8]) -> String {
    const LONGEST: usize = 80;
    // What steers terminals must not reach them.
    let text = String::from_utf8_lossy(bytes).replace(char::is_control, "\u{fffd}");
    if text.chars().count() <= LONGEST {
        return text;
    }
    text.chars().take(LONGEST).chain(['…']).collect()
}

/// A table that is being written, as comma-separated values or as a JSON array with an object for each row.
pub(crate) struct TableWriter<'a> {
    writer: &'a mut dyn Write,
    columns: Vec<String>,
    form: Form,
    rows: usize,
}

/// How a table is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// Comma-separated values under the names of the columns.
    Csv,
    /// Objects whose keys are the columns. What is no finite number is a string.
    Json,
}

impl<'a> TableWriter<'a> {
    /// Begins a table.
    pub(crate) fn new(writer: &'a mut dyn Write, columns: Vec<String>, form: Form) -> io::Result<Self> {
        match form {
            Form::Csv => write_row(writer, &columns)?,
            Form::Json => write!(writer, "[")?,
        }
        Ok(Self { writer, columns, form, rows: 0 })
    }

    /// Writes a row, a field for each column.
    pub(crate) fn row(&mut self, fields: impl Iterator<Item = String>) -> io::Result<()> {
        self.rows += 1;
        match self.form {
            Form::Csv => write_row(self.writer, fields),
            Form::Json => {
                let separator = if self.rows == 1 { "" } else { "," };
                let members: Vec<String> =
                    self.columns.iter().zip(fields).map(|(name, field)| member(name, &field)).collect();
                write!(self.writer, "{separator}\n  {{{}}}", members.join(", "))
            }
        }
    }

    /// Ends the table.
    pub(crate) fn finish(self) -> io::Result<()> {
        match self.form {
            Form::Csv => Ok(()),
            Form::Json => writeln!(self.writer, "\n]"),
        }
    }
}

/// A member of a JSON object. Finite numbers of tables are numbers of JSON as they stand.
fn member(name: &str, field: &str) -> String {
    let is_number = field.parse().is_ok_and(f64::is_finite);
    if is_number { format!("\"{name}\": {field}") } else { format!("\"{name}\": \"{field}\"") }
}

/// Writes a row of fields.
pub(crate) fn write_row<I>(writer: &mut dyn Write, fields: I) -> io::Result<()>
where
    I: IntoIterator,
    I::Item: AsRef<str>,
{
    for (place, field) in fields.into_iter().enumerate() {
        if place > 0 {
            writer.write_all(b",")?;
        }
        writer.write_all(field.as_ref().as_bytes())?;
    }
    writer.write_all(b"\n")
}

/// A float by the shortest digits that read back to it; `nan`, `inf` and `-inf` for what has no digits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Digits<T>(pub(crate) T);

impl<T: Copy + Into<f64> + Display + LowerExp> Display for Digits<T> {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        let magnitude = self.0.into().abs();
        if magnitude.is_nan() {
            formatter.write_str("nan")
        } else if magnitude != 0.0 && !(1e-5..1e16).contains(&magnitude) && magnitude.is_finite() {
            LowerExp::fmt(&self.0, formatter)
        } else {
            Display::fmt(&self.0, formatter)
        }
    }
}

/// [`Digits`] as a field of a table.
pub(crate) fn digits<T: Copy + Into<f64> + Display + LowerExp>(value: T) -> String {
    Digits(value).to_string()
}

#[cfg(test)]
mod tests {
    use iso_expr::random::Random;

    use super::*;

    fn table<const N: usize>(text: &str, names: [&str; N]) -> Result<[Vec<f64>; N], String> {
        let table = read_from(text.as_bytes(), Path::new("t.csv"), names);
        table.map(|table| table.columns).map_err(|error| error.to_string())
    }

    #[test]
    fn columns_are_found_by_name() {
        let text = "# a comment\ny,note,x\n1,first,2\n# another\n -3 , \"a,b\" , 4e-3\n";
        assert_eq!(table(text, ["x", "y"]), Ok([vec![2.0, 4e-3], vec![1.0, -3.0]]));
        assert_eq!(table("x\r\n1\r\n", ["x"]), Ok([vec![1.0]]));
        assert_eq!(table("\u{feff}x\n1", ["x"]), Ok([vec![1.0]]));
        assert_eq!(table("x", ["x"]), Ok([vec![]]));
    }

    #[test]
    fn errors_name_file_line_and_column() {
        let error = |text| table(text, ["x", "y"]).unwrap_err();
        assert_eq!(
            error(""),
            "t.csv:1: expected a first line that names the columns x,y, but the file is empty"
        );
        assert_eq!(error("#\nx,z\n"), "t.csv:2: there is no column `y`; the columns are x,z");
        assert_eq!(error("x,y,x\n"), "t.csv:1: there are several columns `x`");
        assert_eq!(
            error("x,y\n1,2\n3\n"),
            "t.csv:3: column `y` is missing, for the row has only 1 of 2 columns"
        );
        assert_eq!(
            error("x,y\n# comment\n\n1,2\n3,four"),
            "t.csv:5: column `y`: expected a number, found `four`"
        );
        let too_long =
            "t.csv:2: the row has 4 fields, but there are 2 columns; numbers have points, not commas";
        assert_eq!(error("x,y\n1,5,2,3\n"), too_long);
        assert_eq!(table("x,y\n1,2,\n", ["x", "y"]), Ok([vec![1.0], vec![2.0]]));
        let endless = "x".repeat(1 << 21);
        assert_eq!(error(&endless), "t.csv:1: the line is longer than 1048576 bytes");
        assert!(error("x,\u{1b}[2J").ends_with("are x,\u{fffd}[2J"), "{}", error("x,\u{1b}[2J"));
        let long = format!("x,y\n{},0\n", "9e".repeat(60));
        assert!(error(&long).ends_with("9e9e…`"), "{}", error(&long));
    }

    #[test]
    fn any_bytes_are_read_or_refused() {
        const PIECES: [&[u8]; 18] = [
            b"x",
            b"y",
            b",",
            b",",
            b"\n",
            b"\n",
            b"\"",
            b"#",
            b"1",
            b"-2e5",
            b"nan",
            b"inf",
            b" ",
            b"\r",
            b"\xef\xbb\xbf",
            b"1e999",
            b"\xff",
            b"\0",
        ];
        let mut random = Random::new(1);
        for _ in 0..20_000 {
            let mut bytes = if random.below(2) == 0 { b"x,y\n".to_vec() } else { Vec::new() };
            (0..random.below(24)).for_each(|_| bytes.extend_from_slice(random.choose(&PIECES)));
            property::bytes_are_read_or_refused(&bytes);
        }
    }

    #[test]
    fn digits_read_back_to_the_same_float() {
        let edges =
            [0.0, -0.0, 0.1, -1e-5, 9.9e-6, 1e16, 1e300, f64::MIN_POSITIVE, 5e-324, f64::MAX, 1.0 / 3.0];
        for value in edges.into_iter().chain([f64::INFINITY, f64::NEG_INFINITY]) {
            let text = digits(value);
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits(), "{text}");
            assert!(text.len() < 26, "{text}");
        }
        assert_eq!(digits(f64::NAN), "nan");
        assert_eq!([digits(0.1_f32), digits(-1e-6_f32)], ["0.1", "-1e-6"]);
    }
}
