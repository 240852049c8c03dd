//! Which cells hold the surface.

use glam::DVec3;
use iso_expr::{BatchKernel, Scratch};
use rayon::prelude::*;

use crate::batch::PointBatch;
use crate::paper::lattice::{self, Lattice};
use crate::sign::Signs;
use crate::{Counters, GridError, Stop};

/// Points evaluated by one call of the kernel.
const BATCH: usize = 1024;
/// Cells examined together.
const SUSPECTS: usize = 64;

/// The cells of a grid, and which of them hold the surface.
#[derive(Debug)]
pub(crate) struct Cells {
    counts: [usize; 3],
    states: Vec<State>,
}

/// What is known of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// Its corners have one sign.
    Plain,
    /// Its corners have one sign, and so have the corners of its parts. The label that keeps it from another examination.
    Examined,
    /// It holds the surface: an existence cell.
    Existence,
}

impl Cells {
    /// Finds the existence cells of a grid: first by the signs at its points, then by examining again, in parts, each
    /// other cell that borders an existence cell, until no such cell is left. An error when `stop` is requested.
    pub(crate) fn find(
        kernel: &dyn BatchKernel,
        stop: &Stop,
        lattice: &Lattice,
        refinement: [u32; 3],
        counters: &mut Counters,
    ) -> Result<Self, GridError> {
        let signs = signs_at_points(kernel, stop, lattice);
        stop.check()?;
        counters.preprocess_evaluations += signs.len() as u64;
        let corner_signs = |cell: usize| -> Signs {
            let place = lattice::place(cell, lattice.cells());
            lattice::corners(place)
                .map(|corner| signs[lattice::index(corner, lattice.points())])
                .into_iter()
                .collect()
        };
        let counts = lattice.cells();
        let states: Vec<State> = (0..counts.iter().product())
            .into_par_iter()
            .map(|cell| if corner_signs(cell).differ() { State::Existence } else { State::Plain })
            .collect();
        let mut cells = Self { counts, states };
        let mut newest: Vec<usize> = cells.existence().collect();
        counters.cells += cells.states.len() as u64;
        counters.existence_cells += newest.len() as u64;
        let examination = Examination { kernel, stop, refinement };
        while !newest.is_empty() {
            stop.check()?;
            let candidates = cells.label_plain_neighbours(&newest);
            let found = examination.of_all(&candidates, |cell| {
                let place = lattice::place(cell, counts);
                let far = place.map(|place| place + 1);
                Suspect { near: lattice.point(place), far: lattice.point(far), signs: corner_signs(cell) }
            });
            counters.preprocess_evaluations += found.evaluations;
            counters.examined_cells += candidates.len() as u64;
            counters.rescued_cells += found.holding.len() as u64;
            counters.existence_cells += found.holding.len() as u64;
            newest = found.holding;
            for &cell in &newest {
                cells.states[cell] = State::Existence;
            }
        }
        stop.check()?;
        Ok(cells)
    }

    /// Whether the cell at `place` holds the surface. Places beyond the last along an axis are those of cells like it.
    pub(crate) fn holds_surface(&self, place: [usize; 3]) -> bool {
        let place = std::array::from_fn(|axis| place[axis].min(self.counts[axis] - 1));
        self.states[lattice::index(place, self.counts)] == State::Existence
    }

    fn existence(&self) -> impl Iterator<Item = usize> {
        self.states.iter().enumerate().filter(|(_, state)| **state == State::Existence).map(|(cell, _)| cell)
    }

    /// Labels the plain cells that border any of `cells` as examined, and lists them.
    fn label_plain_neighbours(&mut self, cells: &[usize]) -> Vec<usize> {
        let mut labelled = Vec::new();
        for &cell in cells {
            for neighbour in lattice::neighbours(lattice::place(cell, self.counts), self.counts) {
                let neighbour = lattice::index(neighbour, self.counts);
                if self.states[neighbour] == State::Plain {
                    self.states[neighbour] = State::Examined;
                    labelled.push(neighbour);
                }
            }
        }
        labelled
    }
}

/// The signs at all points of a grid, each evaluated once, until `stop` is requested.
fn signs_at_points(kernel: &dyn BatchKernel, stop: &Stop, lattice: &Lattice) -> Vec<Signs> {
    let counts = lattice.points();
    let mut signs = vec![Signs::NONE; counts.iter().product()];
    signs.par_chunks_mut(BATCH).enumerate().for_each_init(
        || (PointBatch::default(), Scratch::default()),
        |(batch, scratch), (chunk, signs)| {
            if stop.is_requested() {
                return;
            }
            batch.clear();
            for offset in 0..signs.len() {
                batch.push(lattice.point(lattice::place(chunk * BATCH + offset, counts)));
            }
            for (sign, &value) in signs.iter_mut().zip(batch.evaluate(kernel, scratch, 1)) {
                *sign = Signs::of(value);
            }
        },
    );
    signs
}

/// The second look at cells whose corners have one sign.
pub(crate) struct Examination<'a> {
    pub(crate) kernel: &'a dyn BatchKernel,
    pub(crate) stop: &'a Stop,
    pub(crate) refinement: [u32; 3],
}

/// A cell to be looked at again.
pub(crate) struct Suspect {
    /// The corner with the smallest coordinates.
    pub(crate) near: DVec3,
    /// The corner with the largest coordinates.
    pub(crate) far: DVec3,
    /// The signs at its corners.
    pub(crate) signs: Signs,
}

/// What the second look found.
pub(crate) struct Found<C> {
    /// The cells that hold the surface after all, in the order in which they were given.
    pub(crate) holding: Vec<C>,
    /// How many points were evaluated.
    pub(crate) evaluations: u64,
}

impl Examination<'_> {
    /// Examines cells, each on its own, over all threads, until it is stopped.
    pub(crate) fn of_all<C: Copy + Send + Sync>(
        &self,
        cells: &[C],
        suspect: impl Fn(C) -> Suspect + Sync,
    ) -> Found<C> {
        let examined: Vec<(Vec<C>, u64)> = cells
            .par_chunks(SUSPECTS)
            .map_init(
                || (PointBatch::default(), Scratch::default()),
                |(batch, scratch), cells| {
                    if self.stop.is_requested() {
                        return (Vec::new(), 0);
                    }
                    let mut suspects: Vec<Suspect> = cells.iter().map(|&cell| suspect(cell)).collect();
                    let evaluations = self.of_some(&mut suspects, batch, scratch);
                    let holding = cells.iter().zip(&suspects).filter(|(_, suspect)| suspect.signs.differ());
                    (holding.map(|(&cell, _)| cell).collect(), evaluations)
                },
            )
            .collect();
        Found {
            evaluations: examined.iter().map(|(_, evaluations)| evaluations).sum(),
            holding: examined.into_iter().flat_map(|(holding, _)| holding).collect(),
        }
    }

    /// Adds the signs at the corners of each cell's parts to the cell's own, a layer of corners at a time, until they
    /// differ. Says how many corners were evaluated.
    fn of_some(&self, suspects: &mut [Suspect], batch: &mut PointBatch, scratch: &mut Scratch) -> u64 {
        let [parts_x, parts_y, parts_z] = self.refinement;
        let mut evaluations = 0;
        for k in 0..=parts_z {
            let layer: Vec<[u32; 3]> = (0..=parts_y)
                .flat_map(|j| (0..=parts_x).map(move |i| [i, j, k]))
                .filter(|&place| !self.is_corner_of_whole(place))
                .collect();
            if layer.is_empty() {
                continue;
            }
            batch.clear();
            for suspect in suspects.iter().filter(|suspect| !suspect.signs.differ()) {
                layer.iter().for_each(|&place| batch.push(self.corner_of_part(suspect, place)));
            }
            evaluations += batch.len() as u64;
            let mut layers = batch.evaluate(self.kernel, scratch, 1).chunks(layer.len());
            for suspect in suspects.iter_mut().filter(|suspect| !suspect.signs.differ()) {
                let values = layers.next().unwrap_or_default();
                suspect.signs = suspect.signs | values.iter().map(|&value| Signs::of(value)).collect();
            }
        }
        evaluations
    }

    /// Whether a corner of the parts is one of the whole cell too, whose sign is known.
    fn is_corner_of_whole(&self, place: [u32; 3]) -> bool {
        (0..3).all(|axis| place[axis] == 0 || place[axis] == self.refinement[axis])
    }

    fn corner_of_part(&self, suspect: &Suspect, place: [u32; 3]) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|axis| {
            let (near, far) = (suspect.near[axis], suspect.far[axis]);
            let part = f64::from(place[axis]) / f64::from(self.refinement[axis]);
            if place[axis] == self.refinement[axis] { far } else { near + (far - near) * part }
        }))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, Ordering};

    use super::*;
    use crate::testing::{Function, surface_without_gradient, trace};
    use crate::{Grid, GridSettings, Kernel, Outcome, Ray, Region, Tracer};

    /// A ball, and a rod from it that is thinner than a cell of five and passes between their corners.
    fn ball_and_rod(p: DVec3) -> f64 {
        let ball = (p + DVec3::new(0.8, 0.0, 0.0)).length_squared() - 0.35 * 0.35;
        let rod = p.y * p.y + p.z * p.z - 0.1 * 0.1;
        ball.min(rod)
    }

    /// Waves with holes where they are undefined.
    fn waves(p: DVec3) -> f64 {
        if (5.0 * p.y).sin() * p.x > 0.7 {
            f64::NAN
        } else {
            (11.0 * p.x).sin() + (9.0 * p.y).sin() * (7.0 * p.z).cos()
        }
    }

    fn cube() -> Region {
        Region::new(DVec3::splat(-1.0), DVec3::splat(1.0)).unwrap()
    }

    fn grid(function: Function, settings: &GridSettings) -> Grid {
        Grid::new(&surface_without_gradient(function), cube(), settings).unwrap()
    }

    #[test]
    fn what_the_corners_miss_is_found_from_its_neighbours() {
        let across_the_rod = Ray { origin: DVec3::new(0.9, 3.0, 0.0), direction: DVec3::NEG_Y };
        let settings = GridSettings::new([5; 3]);
        assert_eq!(settings.refinement, [3; 3]);
        let looked_again = grid(ball_and_rod, &settings);
        assert!(
            matches!(trace(&looked_again, across_the_rod), Outcome::Hit(hit) if (hit.t - 2.9).abs() < 1e-15)
        );
        // One after the other, the three cells between the ball and the far end of the rod.
        assert_eq!(looked_again.preprocessing().rescued_cells, 3);

        let looked_once = grid(ball_and_rod, &GridSettings { refinement: [1; 3], ..settings });
        assert_eq!(trace(&looked_once, across_the_rod), Outcome::Miss);
        let counters = looked_once.preprocessing();
        assert_eq!((counters.rescued_cells, counters.preprocess_evaluations), (0, 6 * 6 * 6));
    }

    /// The paper's rule word for word, one cell after the other, until nothing changes.
    fn by_the_rule(function: Function, settings: &GridSettings) -> (Vec<bool>, u64, u64) {
        let lattice = Lattice::new(&cube(), settings.cells);
        let counts = lattice.cells();
        let number_of_cells: usize = counts.iter().product();
        let differ = |cell: usize, parts: [u32; 3]| {
            let place = lattice::place(cell, counts);
            let (near, far) = (lattice.point(place), lattice.point(place.map(|place| place + 1)));
            let mut signs = Signs::NONE;
            for number in 0..(parts[0] + 1) * (parts[1] + 1) * (parts[2] + 1) {
                let place = lattice::place(number as usize, parts.map(|parts| parts as usize + 1));
                let part = |axis: usize| match place[axis] as u32 {
                    end if end == parts[axis] => far[axis],
                    inner => {
                        near[axis] + (far[axis] - near[axis]) * (f64::from(inner) / f64::from(parts[axis]))
                    }
                };
                signs = signs | Signs::of(function(DVec3::new(part(0), part(1), part(2))));
            }
            signs.differ()
        };
        let mut holds: Vec<bool> = (0..number_of_cells).map(|cell| differ(cell, [1; 3])).collect();
        let mut examined = vec![false; number_of_cells];
        let mut rescued = 0;
        loop {
            let next = (0..number_of_cells).find(|&cell| {
                let place = lattice::place(cell, counts);
                let mut neighbours = lattice::neighbours(place, counts);
                !holds[cell]
                    && !examined[cell]
                    && neighbours.any(|other| holds[lattice::index(other, counts)])
            });
            let Some(cell) = next else { break };
            examined[cell] = true;
            if differ(cell, settings.refinement) {
                holds[cell] = true;
                rescued += 1;
            }
        }
        (holds, examined.into_iter().filter(|&examined| examined).count() as u64, rescued)
    }

    #[test]
    fn cells_are_those_of_the_rule_and_each_is_examined_once() {
        let mut rescued_in_all = 0;
        let cases = [(waves as Function, [9, 12, 4]), (waves, [6, 22, 7]), (ball_and_rod, [5, 5, 11])];
        for (function, cells) in cases {
            let settings = GridSettings::new(cells);
            let grid = grid(function, &settings);
            let (holds, examined, rescued) = by_the_rule(function, &settings);
            let lattice = Lattice::new(&cube(), cells);
            let kernel = surface_without_gradient(function);
            let mut counters = Counters::default();
            let found = Cells::find(
                &**kernel.over_points(Kernel::Values).unwrap(),
                &Stop::default(),
                &lattice,
                settings.refinement,
                &mut counters,
            )
            .unwrap();
            for (cell, &holds) in holds.iter().enumerate() {
                assert_eq!(found.holds_surface(lattice::place(cell, lattice.cells())), holds, "cell {cell}");
            }
            assert_eq!(counters, grid.preprocessing());
            assert_eq!((counters.examined_cells, counters.rescued_cells), (examined, rescued));
            assert_eq!(counters.existence_cells, holds.iter().filter(|&&holds| holds).count() as u64);
            assert!(examined > 0, "nothing to examine in {cells:?}");
            rescued_in_all += rescued;
        }
        assert!(rescued_in_all > 10, "{rescued_in_all} cells rescued");
    }

    #[test]
    fn evaluations_are_counted() {
        static EVALUATIONS: AtomicU64 = AtomicU64::new(0);
        let surface = surface_without_gradient(|p| {
            EVALUATIONS.fetch_add(1, Ordering::Relaxed);
            ball_and_rod(p)
        });
        let settings = GridSettings::new([5; 3]);
        let grid = Grid::new(&surface, cube(), &settings).unwrap();
        let counters = grid.preprocessing();
        assert_eq!(counters.preprocess_evaluations, EVALUATIONS.swap(0, Ordering::Relaxed));
        // All grid points, and not all 4·4·4 − 8 further corners of each cell that was examined.
        let most = 6 * 6 * 6 + 56 * counters.examined_cells;
        assert!(counters.preprocess_evaluations > 6 * 6 * 6 && counters.preprocess_evaluations < most);
    }

    #[test]
    fn constants_and_undefined_functions_have_no_cells_but_zero_has_all() {
        for (function, existence) in [
            ((|_| 1.0) as Function, 0),
            (|_| -1.0, 0),
            (|_| f64::NAN, 0),
            (|_| f64::NEG_INFINITY, 0),
            (|p| if p.x < 0.1 { f64::INFINITY } else { -1.0 }, 0),
            (|_| -0.0, 125),
        ] {
            assert_eq!(grid(function, &GridSettings::new([5; 3])).preprocessing().existence_cells, existence);
        }
    }
}
