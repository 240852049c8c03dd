//! The figures of the paper that this project began with, made again.
//!
//!     cargo run --release --example figures
//!
//! Figure 1 is the processor time of a picture of (x² + y² − 1)² + 4z² + 0.5x = C against the number N of cells along each axis of the
//! grid, N = 0 being no grid at all. Figure 2 is the picture. Both go to `docs/figures/`, the first one as a table too.

use std::error::Error;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use glam::DVec3;
use iso_expr::{Ast, Engine, Interpreter, Program};
use iso_grid::{GridSettings, Method, Region, RootFinding, Surface};
use iso_jit::Jit;
use iso_render::{
    Camera, ImageFormat, Layers, Look, Picture, Plan, Projection, Scene, Shading, Size, Smoothing, Stopwatch,
    View, Wanted, render,
};
use plotters::prelude::*;
use rayon::ThreadPoolBuilder;

const FORMULA: &str = "(x^2+y^2-1)^2 + 4z^2 + 0.5x = 0.2";
/// The paper's numbers of cells along each axis.
const CELLS: [u32; 7] = [0, 4, 8, 15, 30, 45, 60];
/// The paper's picture is this wide and high.
const SIDE: u32 = 256;
/// Every picture is made this often; the least time counts, for all that disturbs it adds to it.
const RUNS: usize = 7;

fn main() -> Result<(), Box<dyn Error>> {
    ThreadPoolBuilder::new().num_threads(1).build_global()?;
    let paper = Paper::new()?;
    let rows = paper.measure()?;
    let folder = Path::new("docs/figures");
    fs::create_dir_all(folder)?;
    let table = table(&rows);
    println!("{table}");
    fs::write(folder.join("figure1.md"), table)?;
    plot(&rows, &folder.join("figure1.svg"))?;
    paper.write_picture(&folder.join("figure2.png"))
}

/// The paper's scene.
struct Paper {
    value: Program,
    region: Region,
    camera: Camera,
    engines: [Arc<dyn Engine>; 2],
}

/// What was measured for one number of cells.
struct Row {
    cells: u32,
    /// The time of the interpreter and of native code.
    times: [Duration; 2],
    /// Pixels that show the surface here and not in the picture with the most cells, or the other way round.
    different: usize,
    /// The root mean square difference of the pixels' bytes from the picture with the most cells.
    deviation: f64,
}

impl Paper {
    fn new() -> Result<Self, Box<dyn Error>> {
        let formula = Ast::parse(FORMULA)?.lower(&[])?;
        let value = formula.program().simplified();
        let region = Region::new(DVec3::new(-1.5, -1.5, -0.6), DVec3::new(1.5, 1.5, 0.6))?;
        Ok(Self {
            value,
            camera: Camera::new(View::DEFAULT, Projection::DEFAULT, &region, Size::new(SIDE, SIDE)?)?,
            region,
            engines: [Arc::new(Interpreter), Arc::new(Jit::new()?)],
        })
    }

    fn measure(&self) -> Result<Vec<Row>, Box<dyn Error>> {
        let finest = self.draw(&self.engines[1], CELLS[CELLS.len() - 1])?.0;
        CELLS.iter().map(|&cells| self.measure_cells(cells, &finest)).collect()
    }

    fn measure_cells(&self, cells: u32, finest: &Picture) -> Result<Row, Box<dyn Error>> {
        let (picture, _) = self.draw(&self.engines[1], cells)?;
        let mut times = [Duration::MAX; 2];
        // The engines take turns, so that a change of the machine's speed meets both.
        for _ in 0..RUNS {
            for (engine, least) in self.engines.iter().zip(&mut times) {
                let (other, time) = self.draw(engine, cells)?;
                assert_eq!(other.color, picture.color, "engines agree bit for bit");
                *least = time.min(*least);
            }
        }
        let different =
            picture.statuses.iter().zip(&finest.statuses).filter(|(status, finest)| status != finest);
        Ok(Row { cells, times, different: different.count(), deviation: deviation(&picture, finest) })
    }

    /// The picture with this many cells along each axis, and its time: preprocessing, tracing and shading.
    fn draw(&self, engine: &Arc<dyn Engine>, cells: u32) -> Result<(Picture, Duration), Box<dyn Error>> {
        let surface = Surface::new(Arc::clone(engine), self.value.clone());
        let plan = Plan::new(&Wanted {
            program: &self.value,
            method: match cells {
                0 => Method::Direct { step: GridSettings::STEP, roots: RootFinding::PAPER },
                _ => Method::Grid(GridSettings::new([cells; 3])),
            },
            has_parameters: false,
            projection: Some(Projection::DEFAULT),
            box_is_given: true,
            layers: Layers { statuses: true, ..Layers::COLOR },
            smoothing: Smoothing::NONE,
        });
        plan.compile(&surface)?;
        let clock = ProcessorClock::start();
        let tracer = plan.tracer(&surface, self.region)?;
        let shading = Shading::new(&self.camera, &Look::DEFAULT);
        let scene = Scene {
            plan: &plan,
            surface: &surface,
            tracer: tracer.as_ref(),
            camera: &self.camera,
            shading: &shading,
        };
        let picture = render(&scene, Size::new(SIDE, SIDE)?, &|_, _| ())?;
        Ok((picture, clock.elapsed()))
    }

    fn write_picture(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let (picture, _) = self.draw(&self.engines[1], CELLS[CELLS.len() - 1])?;
        picture.write_color(ImageFormat::of(path)?, BufWriter::new(File::create(path)?))?;
        Ok(())
    }
}

/// The time that this program's threads spent on processors, which is what the paper measures; on systems that do not say,
/// the time on the clock.
struct ProcessorClock {
    busy: Option<Duration>,
    wall: Stopwatch,
}

impl ProcessorClock {
    fn start() -> Self {
        Self { busy: busy(), wall: Stopwatch::start() }
    }

    fn elapsed(&self) -> Duration {
        match (self.busy, busy()) {
            (Some(before), Some(now)) => now - before,
            _ => self.wall.elapsed(),
        }
    }
}

/// Linux keeps the nanoseconds of each thread in the first field of its `schedstat`.
fn busy() -> Option<Duration> {
    let mut nanoseconds = 0;
    for thread in fs::read_dir("/proc/self/task").ok()? {
        let text = fs::read_to_string(thread.ok()?.path().join("schedstat")).ok()?;
        nanoseconds += text.split(' ').next()?.parse::<u64>().ok()?;
    }
    Some(Duration::from_nanos(nanoseconds))
}

fn deviation(picture: &Picture, finest: &Picture) -> f64 {
    let bytes = || picture.color.as_flattened().iter().zip(finest.color.as_flattened());
    let squares: f64 = bytes().map(|(&a, &b)| (f64::from(a) - f64::from(b)).powi(2)).sum();
    (squares / bytes().count() as f64).sqrt()
}

fn milliseconds(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

fn table(rows: &[Row]) -> String {
    let mut table = "\
| N | interpreter, ms | native code, ms | gain | pixels unlike N = 60 | RMS difference of bytes |
|--:|--:|--:|--:|--:|--:|
"
    .to_owned();
    for Row { cells, times, different, deviation } in rows {
        let [interpreter, native] = times.map(milliseconds);
        let gain = interpreter / native;
        table += &format!(
            "| {cells} | {interpreter:.1} | {native:.1} | {gain:.1} | {different} | {deviation:.2} |\n"
        );
    }
    table
}

fn plot(rows: &[Row], path: &Path) -> Result<(), Box<dyn Error>> {
    let most = rows.iter().flat_map(|row| row.times).map(milliseconds).fold(0.0, f64::max);
    let root = SVGBackend::new(path, (640, 400)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .margin(16)
        .x_label_area_size(40)
        .y_label_area_size(56)
        .build_cartesian_2d(-1.0..62.0, 0.0..1.05 * most)?;
    chart
        .configure_mesh()
        .x_desc("N, cells along each axis (0: no grid)")
        .y_desc("processor time of a picture of 256x256, ms")
        .light_line_style(WHITE)
        .draw()?;
    let (blue, orange) = (RGBColor(72, 138, 196), RGBColor(214, 122, 32));
    for (engine, (name, color)) in [("interpreter", blue), ("native code", orange)].into_iter().enumerate() {
        let points = || rows.iter().map(move |row| (f64::from(row.cells), milliseconds(row.times[engine])));
        chart
            .draw_series(LineSeries::new(points(), color.stroke_width(2)).point_size(3))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], color.stroke_width(2)));
    }
    chart.configure_series_labels().border_style(BLACK).background_style(WHITE).draw()?;
    root.present()?;
    Ok(())
}
