//! `iso eval`: values of a formula at points, enclosures over boxes.

use std::path::Path;
use std::sync::Arc;

use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::{Decoration, Engine, Program, Scratch};

use crate::engine::engine;
use crate::failure::Failure;
use crate::flags::{EvalFlags, PlacesFlags};
use crate::formula::{file_of, minus_level, understand};
use crate::output::Destination;
use crate::rounding::{Rounded, rounded};
use crate::table::{self, Form, Table, TableError, TableWriter, digits};

/// Rows that are evaluated at a time.
const BATCH: usize = 4096;

/// Evaluates a formula at points, or over boxes.
pub(crate) fn run(flags: EvalFlags) -> Result<(), Failure> {
    let places = &flags.places;
    let form = flags.table.form();
    let destination = Destination::new(flags.table.output)?;
    let formula_file = file_of(&flags.formula.formula);
    let mut sources = places.boxes.iter().chain(&places.points).chain(&formula_file);
    sources.try_for_each(|source| destination.spares(source))?;
    let value = minus_level(&understand(&flags.formula)?, flags.level.level)?.simplified();
    let program = if places.gradient { value.with_gradient().simplified() } else { value };
    let engine = engine(flags.engine.engine)?;
    if let Some(path) = &places.boxes {
        return over_boxes(engine, &program, &read_boxes(path)?, &destination, form);
    }
    let points = points(places)?;
    let evaluate = if places.error { with_errors } else { at_points };
    evaluate(engine, &program, &points, &destination, form)
}

/// The coordinates of the points that were given.
fn points(places: &PlacesFlags) -> Result<[Vec<f64>; 3], TableError> {
    match &places.points {
        Some(path) => Ok(table::read(path, ["x", "y", "z"])?.columns),
        None => Ok([0, 1, 2].map(|axis| places.at.iter().map(|point| point[axis]).collect())),
    }
}

/// The columns of values, as many as there are outputs.
const VALUE_COLUMNS: [&str; 4] = ["value", "dx", "dy", "dz"];

fn at_points(
    engine: Arc<dyn Engine>,
    program: &Program,
    points: &[Vec<f64>; 3],
    destination: &Destination,
    form: Form,
) -> Result<(), Failure> {
    let kernel = engine.batch(program)?;
    let outputs = program.outputs().len();
    let columns = VALUE_COLUMNS[..outputs].iter().map(ToString::to_string).collect();
    let (mut scratch, mut values) = (Scratch::default(), Vec::new());
    write_batches(points, columns, (destination, form), |batch| {
        let count = batch[0].len();
        values.resize(outputs * count, 0.0);
        kernel.evaluate(&mut scratch, &batch, &mut values);
        // Where F is undefined it has no derivatives, whatever their formulas give.
        let found = |row: usize, output: usize| {
            if values[row].is_nan() { f64::NAN } else { values[output * count + row] }
        };
        let fields = |row| (0..outputs).map(|output| digits(found(row, output))).collect();
        (0..count).map(fields).collect()
    })
}

/// Values at points, each with the bound of its rounding error and the digits that it may have lost.
fn with_errors(
    engine: Arc<dyn Engine>,
    program: &Program,
    points: &[Vec<f64>; 3],
    destination: &Destination,
    form: Form,
) -> Result<(), Failure> {
    let (values, enclosures) = (engine.batch(program)?, engine.boxes(program)?);
    let outputs = program.outputs().len();
    let columns = |name: &&str| [name.to_string(), format!("{name}_error"), format!("{name}_digits_lost")];
    let columns = VALUE_COLUMNS[..outputs].iter().flat_map(columns).collect();
    let mut scratch = Scratch::default();
    write_batches(points, columns, (destination, form), |batch| {
        let count = batch[0].len();
        let found = rounded(&*values, &*enclosures, &mut scratch, batch, outputs);
        let fields = |row: usize| {
            (0..outputs).flat_map(|output| Rounded::fields(found[output * count + row])).collect()
        };
        (0..count).map(fields).collect()
    })
}

/// Writes a table with a row for each point. `rows` gives the fields of those of a batch, by their coordinates.
fn write_batches(
    [x, y, z]: &[Vec<f64>; 3],
    columns: Vec<String>,
    (destination, form): (&Destination, Form),
    mut rows: impl FnMut([&[f64]; 3]) -> Vec<Vec<String>>,
) -> Result<(), Failure> {
    destination.write(|writer| {
        let mut table = TableWriter::new(writer, columns, form)?;
        for ((x, y), z) in x.chunks(BATCH).zip(y.chunks(BATCH)).zip(z.chunks(BATCH)) {
            rows([x, y, z]).into_iter().try_for_each(|fields| table.row(fields.into_iter()))?;
        }
        table.finish()
    })
}

impl Rounded {
    /// The value, the bound of its error, and the digits lost to a tenth, as a table has them.
    fn fields(self) -> [String; 3] {
        [digits(self.value), digits(self.error), format!("{:.1}", self.digits_lost()).to_lowercase()]
    }
}

fn over_boxes(
    engine: Arc<dyn Engine>,
    program: &Program,
    boxes: &Table<6>,
    destination: &Destination,
    form: Form,
) -> Result<(), Failure> {
    let kernel = engine.boxes(program)?;
    let outputs = program.outputs().len();
    let mut scratch = Scratch::default();
    destination.write(|writer| {
        let mut table = TableWriter::new(writer, box_columns(outputs), form)?;
        for start in (0..boxes.rows()).step_by(BATCH) {
            let rows = start..boxes.rows().min(start + BATCH);
            let [x_lo, x_hi, y_lo, y_hi, z_lo, z_hi] =
                boxes.columns.each_ref().map(|column| &column[rows.clone()]);
            let batch = Boxes { lo: [x_lo, y_lo, z_lo], hi: [x_hi, y_hi, z_hi] };
            let mut found = Found::with_room(rows.len() * outputs);
            kernel.evaluate(&mut scratch, batch, found.enclosures());
            found.limit_derivatives(rows.len());
            for row in 0..rows.len() {
                table.row(found.fields((0..outputs).map(|output| output * rows.len() + row)))?;
            }
        }
        table.finish()
    })
}

fn box_columns(outputs: usize) -> Vec<String> {
    let of = |prefix: &str| ["lo", "hi", "decoration"].map(|end| format!("{prefix}{end}"));
    ["", "dx_", "dy_", "dz_"][..outputs].iter().copied().flat_map(of).collect()
}

/// The boxes of a table. Infinite ends are open; nan makes an empty box.
fn read_boxes(path: &Path) -> Result<Table<6>, TableError> {
    let boxes = table::read(path, ["x_lo", "x_hi", "y_lo", "y_hi", "z_lo", "z_hi"])?;
    for row in 0..boxes.rows() {
        let [x_lo, x_hi, y_lo, y_hi, z_lo, z_hi] = boxes.row(row);
        for (axis, lo, hi) in [('x', x_lo, x_hi), ('y', y_lo, y_hi), ('z', z_lo, z_hi)] {
            if lo > hi || lo == f64::INFINITY || hi == f64::NEG_INFINITY {
                return Err(boxes.meaningless(
                    row,
                    format!("no number lies between {axis}_lo = {lo} and {axis}_hi = {hi}"),
                ));
            }
        }
    }
    Ok(boxes)
}

/// Enclosures of a batch.
struct Found {
    lo: Vec<f64>,
    hi: Vec<f64>,
    decoration: Vec<Decoration>,
}

impl Found {
    fn with_room(count: usize) -> Self {
        Self { lo: vec![0.0; count], hi: vec![0.0; count], decoration: vec![Decoration::Trivial; count] }
    }

    fn enclosures(&mut self) -> Enclosures<'_> {
        Enclosures { lo: &mut self.lo, hi: &mut self.hi, decoration: &mut self.decoration }
    }

    /// Derivatives of F over `count` boxes exist where F is defined and continuous at most: elsewhere nothing is said of them but what they are
    /// where they are.
    fn limit_derivatives(&mut self, count: usize) {
        for place in count..self.lo.len() {
            let of_value = place % count;
            if self.decoration[of_value] < Decoration::Continuous {
                self.decoration[place] = Decoration::Trivial;
            }
            if self.lo[of_value].is_nan() {
                (self.lo[place], self.hi[place]) = (f64::NAN, f64::NAN);
            }
        }
    }

    fn fields(&self, places: impl Iterator<Item = usize>) -> impl Iterator<Item = String> {
        places.flat_map(|place| {
            let decoration = decoration_name(self.decoration[place]).to_owned();
            [end(self.lo[place]), end(self.hi[place]), decoration]
        })
    }
}

/// An end of an enclosure; that of an empty one is NaN. Zeros lose their sign, which enclosures use for themselves.
fn end(value: f64) -> String {
    if value.is_nan() { "empty".to_owned() } else { digits(value + 0.0) }
}

/// The decoration's name in IEEE 1788.
fn decoration_name(decoration: Decoration) -> &'static str {
    match decoration {
        Decoration::Common => "com",
        Decoration::Continuous => "dac",
        Decoration::Defined => "def",
        Decoration::Trivial => "trv",
    }
}
