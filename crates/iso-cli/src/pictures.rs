//! The files that a picture is written to.

use std::io::{self, Cursor, Write};
use std::path::{Path, PathBuf};

use iso_render::{ImageFormat, Layers, Picture, Size, Status};

use crate::failure::Failure;
use crate::flags::{LayerFlags, PaintFlags};
use crate::output::{Destination, OutputFile, is_standard_output, to_standard_output};
use crate::table::{Digits, write_row};

/// The files that a picture is written to, all of them writable as far as can be known.
pub(crate) struct PictureFiles {
    color: Option<(Destination, ImageFormat)>,
    depth: Option<OutputFile>,
    normals: Option<OutputFile>,
    points: Option<OutputFile>,
}

impl PictureFiles {
    /// Checks names and places before anything is computed.
    pub(crate) fn resolve(flags: &LayerFlags) -> Result<Self, Failure> {
        Self::named(color(flags, STILL), flags, &|path| path.to_owned())
    }

    /// The same for a picture of a sequence of `count`, whose number goes into all names. An animation is no file of its own.
    pub(crate) fn numbered(flags: &LayerFlags, number: u32, count: u32) -> Result<Self, Failure> {
        let color = color(flags, ANIMATION).filter(|path| !is_animation(path));
        if color.as_deref().is_some_and(is_standard_output) {
            let problem = "a sequence has no place in standard output";
            return Err(Failure::usage(problem, "name a .gif file, or any other for its numbered pictures"));
        }
        Self::named(color, flags, &|path| with_number(path, number, count))
    }

    /// Files with the names that `rename` makes of those given.
    fn named(
        color: Option<PathBuf>,
        flags: &LayerFlags,
        rename: &dyn Fn(&Path) -> PathBuf,
    ) -> Result<Self, Failure> {
        check_names(flags)?;
        let color = color.map(|path| {
            let format = format(&path, flags)?;
            Ok::<_, Failure>((Destination::new(Some(rename(&path)))?, format))
        });
        let file = |path: &Option<PathBuf>| path.as_deref().map(rename).map(OutputFile::new).transpose();
        let files = Self {
            color: color.transpose()?,
            depth: file(&flags.depth)?,
            normals: file(&flags.normals)?,
            points: file(&flags.points)?,
        };
        files.check_apart()?;
        Ok(files)
    }

    /// No file may be written over another.
    fn check_apart(&self) -> Result<(), Failure> {
        let files: Vec<_> = self.all().collect();
        let is_lost = |&(place, file): &(usize, &&OutputFile)| {
            files[..place].iter().any(|earlier| earlier.is_replaced_by(file))
        };
        let Some((_, file)) = files.iter().enumerate().find(is_lost) else { return Ok(()) };
        let problem = format!("two layers go to one file, {}", file.path().display());
        Err(Failure::usage(problem, "give each a file of its own"))
    }

    /// The files' names as given, the shaded picture first.
    pub(crate) fn names(&self) -> Vec<String> {
        let is_sent = matches!(self.color, Some((Destination::Standard, _)));
        let names = self.all().map(|file| file.path().display().to_string());
        is_sent.then(|| "-".to_owned()).into_iter().chain(names).collect()
    }

    /// All of the files, the shaded picture first.
    pub(crate) fn all(&self) -> impl Iterator<Item = &OutputFile> {
        let color = self.color.as_ref().and_then(|(destination, _)| match destination {
            Destination::File(file) => Some(file),
            Destination::Standard => None,
        });
        let others = [&self.depth, &self.normals, &self.points].into_iter().flatten();
        color.into_iter().chain(others)
    }

    /// Writes all files.
    pub(crate) fn write(&self, picture: &Picture) -> Result<(), Failure> {
        match &self.color {
            Some((Destination::File(file), format)) => {
                file.write(|writer| picture.write_color(*format, writer))?;
            }
            Some((Destination::Standard, format)) => {
                let mut bytes = Cursor::new(Vec::new());
                picture.write_color(*format, &mut bytes)?;
                to_standard_output(|writer| writer.write_all(bytes.get_ref()))?;
            }
            None => {}
        }
        if let Some(file) = &self.depth {
            file.write(|writer| picture.write_depth(writer))?;
        }
        if let Some(file) = &self.normals {
            file.write(|writer| picture.write_normals(writer))?;
        }
        if let Some(file) = &self.points {
            file.write(|writer| write_points(picture, writer))?;
        }
        Ok(())
    }
}

/// Refuses names that say other formats than are written there, formats that cannot hold the picture, and a background without one. Does
/// not look at the disk.
pub(crate) fn check_names(flags: &LayerFlags) -> Result<(), Failure> {
    match color(flags, STILL) {
        Some(path) => format(&path, flags).map(drop)?,
        None => check_shaded("--background", flags.background.background.is_some())?,
    }
    check_extension(flags.depth.as_deref(), "exr", "--depth")?;
    check_extension(flags.normals.as_deref(), "exr", "--normals")?;
    check_extension(flags.points.as_deref(), "csv", "--points")
}

/// Refuses paint where no shaded picture is written.
pub(crate) fn check_paint(paint: &PaintFlags, flags: &LayerFlags) -> Result<(), Failure> {
    if color(flags, STILL).is_some() {
        return Ok(());
    }
    check_shaded("--colors", paint.colors.is_some())?;
    check_shaded("--show-status", paint.show_status)
}

/// Refuses a flag of shaded pictures where there is none.
fn check_shaded(flag: &str, is_given: bool) -> Result<(), Failure> {
    if !is_given {
        return Ok(());
    }
    let problem = format!("{flag} is given, but no shaded picture is written");
    Err(Failure::usage(problem, "name one with -o, or leave it out"))
}

/// The format of the shaded picture, if it can hold that.
fn format(path: &Path, flags: &LayerFlags) -> Result<ImageFormat, Failure> {
    let format = if is_standard_output(path) { ImageFormat::PNG } else { ImageFormat::of(path)? };
    check_size(format, flags.size)?;
    check_transparency(format, flags)?;
    Ok(format)
}

/// Refuses a picture that the format cannot hold.
fn check_size(format: ImageFormat, size: Size) -> Result<(), Failure> {
    let longest = format.longest_side();
    if size.width().max(size.height()) <= longest {
        return Ok(());
    }
    let problem = format!("this format holds no more than {longest} columns and rows");
    Err(Failure::usage(problem, "choose a smaller --size, or a .png file"))
}

/// Refuses a transparent background that the format cannot keep.
fn check_transparency(format: ImageFormat, flags: &LayerFlags) -> Result<(), Failure> {
    if format.has_transparency() || !flags.background.is_transparent() {
        return Ok(());
    }
    let problem = "--background none is given, but this format has no transparency";
    Err(Failure::usage(problem, "choose a .png, .webp or .qoi file"))
}

/// What must be kept of a picture to write the files that `flags` name.
pub(crate) fn layers(flags: &LayerFlags) -> Layers {
    let points = flags.points.is_some();
    let is_shaded = color(flags, STILL).is_some();
    Layers {
        color: is_shaded,
        coverage: is_shaded && flags.background.is_transparent(),
        depth: points || flags.depth.is_some(),
        normals: points || flags.normals.is_some(),
        points,
        statuses: points,
        outcomes: false,
    }
}

/// The shaded picture's name where none is given.
const STILL: &str = "iso.png";
/// That of the pictures of a sequence.
const ANIMATION: &str = "iso.gif";

/// The file of all pictures of a sequence, unless each has its own.
pub(crate) fn animation(flags: &LayerFlags) -> Result<Option<OutputFile>, Failure> {
    let Some(path) = color(flags, ANIMATION).filter(|path| is_animation(path)) else { return Ok(None) };
    format(&path, flags)?;
    OutputFile::new(path).map(Some)
}

fn is_animation(path: &Path) -> bool {
    has_extension(path, "gif")
}

/// The path with a number before its extension, with leading zeros so that names sort as numbers do.
fn with_number(path: &Path, number: u32, count: u32) -> PathBuf {
    let digits = (count - 1).to_string().len();
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!("-{number:0digits$}"));
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}

/// Where the shaded picture goes: when nothing is asked for, that is what is meant, under its usual name.
fn color(flags: &LayerFlags, usual: &str) -> Option<PathBuf> {
    let others = [&flags.depth, &flags.normals, &flags.points];
    let nothing_else = others.into_iter().all(Option::is_none);
    flags.output.clone().or_else(|| nothing_else.then(|| PathBuf::from(usual)))
}

fn check_extension(path: Option<&Path>, extension: &str, flag: &str) -> Result<(), Failure> {
    match path.filter(|path| !has_extension(path, extension)) {
        None => Ok(()),
        Some(path) => {
            let problem =
                format!("{flag} writes .{extension} files, but the name given is {}", path.display());
            Err(Failure::usage(problem, format!("give it a name that ends in .{extension}")))
        }
    }
}

fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|given| given.eq_ignore_ascii_case(extension))
}

/// A row for each pixel, rows of the picture from top to bottom.
fn write_points(picture: &Picture, writer: &mut dyn Write) -> io::Result<()> {
    write_row(writer, ["column", "row", "status", "t", "x", "y", "z", "nx", "ny", "nz"])?;
    // There may be a billion pixels: their rows are written into memory that is kept.
    let mut lines = Vec::new();
    for row in 0..picture.size.height() {
        lines.clear();
        for column in 0..picture.size.width() {
            write_pixel(picture, column, row, &mut lines)?;
        }
        writer.write_all(&lines)?;
    }
    Ok(())
}

fn write_pixel(picture: &Picture, column: u32, row: u32, lines: &mut Vec<u8>) -> io::Result<()> {
    let pixel = picture.size.offset(column, row);
    let status = picture.statuses[pixel];
    write!(lines, "{column},{row},{}", status_name(status))?;
    if status == Status::Unfinished {
        lines.extend_from_slice(b",nan,nan,nan,nan,nan,nan,nan\n");
        return Ok(());
    }
    let (point, normal) = (picture.points.get(pixel), picture.normals.get(pixel));
    for number in [picture.depth.get(pixel), point.x, point.y, point.z] {
        write!(lines, ",{}", Digits(number))?;
    }
    for number in <[f32; 3]>::from(normal) {
        write!(lines, ",{}", Digits(number))?;
    }
    lines.push(b'\n');
    Ok(())
}

/// The name of a status in tables.
pub(crate) fn status_name(status: Status) -> &'static str {
    match status {
        Status::Hit => "hit",
        Status::Touch => "touch",
        Status::Miss => "miss",
        Status::Undecided => "undecided",
        Status::Unfinished => "unfinished",
    }
}
