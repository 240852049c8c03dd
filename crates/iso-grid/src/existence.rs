//! Which cells hold the surface.

use glam::DVec3;
use iso_expr::{BatchKernel, Scratch};
use rayon::prelude::*;

use crate::Counters;
use crate::batch::PointBatch;
use crate::lattice::{self, Lattice};
use crate::sign::Signs;

/// Points evaluated by one call of the kernel.
const BATCH: usize = 1024;

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
    /// other cell that borders an existence cell, until no such cell is left.
    pub(crate) fn find(
        kernel: &dyn BatchKernel,
        lattice: &Lattice,
        refinement: [u32; 3],
        counters: &mut Counters,
    ) -> Self {
        let signs = signs_at_points(kernel, lattice);
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
        let examination = Examination { kernel, refinement };
        while !newest.is_empty() {
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
        cells
    }

    /// Whether the cell at `place` holds the surface.
    pub(crate) fn holds_surface(&self, place: [usize; 3]) -> bool {
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

/// The signs at all points of a grid, each evaluated once.
fn signs_at_points(kernel: &dyn BatchKernel, lattice: &Lattice) -> Vec<Signs> {
    let counts = lattice.points();
    let mut signs = vec![Signs::NONE; counts.iter().product()];
    signs.par_chunks_mut(BATCH).enumerate().for_each_init(
        || (PointBatch::default(), Scratch::default()),
        |(batch, scratch), (chunk, signs)| {
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
    /// Examines cells, each on its own, over all threads.
    pub(crate) fn of_all<C: Copy + Send + Sync>(
        &self,
        cells: &[C],
        suspect: impl Fn(C) -> Suspect + Sync,
    ) -> Found<C> {
        let looks: Vec<(bool, u64)> = cells
            .par_iter()
            .map_init(
                || (PointBatch::default(), Scratch::default()),
                |(batch, scratch), &cell| self.of_one(&suspect(cell), batch, scratch),
            )
            .collect();
        Found {
            holding: cells.iter().zip(&looks).filter(|(_, look)| look.0).map(|(&cell, _)| cell).collect(),
            evaluations: looks.iter().map(|look| look.1).sum(),
        }
    }

    /// Whether the corners of a cell's parts differ in sign, and how many of them were evaluated to see it: a layer of
    /// parts at a time, until signs differ.
    fn of_one(&self, suspect: &Suspect, batch: &mut PointBatch, scratch: &mut Scratch) -> (bool, u64) {
        let [parts_x, parts_y, parts_z] = self.refinement;
        let mut signs = suspect.signs;
        let mut evaluations = 0;
        for k in 0..=parts_z {
            batch.clear();
            for j in 0..=parts_y {
                for i in 0..=parts_x {
                    if !self.is_corner_of_whole([i, j, k]) {
                        batch.push(self.corner_of_part(suspect, [i, j, k]));
                    }
                }
            }
            evaluations += batch.len() as u64;
            let values = batch.evaluate(self.kernel, scratch, 1);
            signs = signs | values.iter().map(|&value| Signs::of(value)).collect();
            if signs.differ() {
                return (true, evaluations);
            }
        }
        (false, evaluations)
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
