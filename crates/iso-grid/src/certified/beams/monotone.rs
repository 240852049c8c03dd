//! The roots of single rays of a beam along which F is monotone.

use std::ops::Range;

use super::beam::Beam;
use super::bundle::{Bundle, Sight};
use super::cuts::Cut;
use super::form::{Form, ROUNDING};
use super::open_rays::together;
use super::pursuit::{Last, Pursuit};
use super::rounding::Rounding;
use super::sheaf::{Sheaf, Start};
use super::subdivision::{Part, SMALLEST, Subdivision};
use crate::certified::clip::Clip;
use crate::{Kernel, Outcome, Span, Workspace};

/// How many times narrower than what is wanted an enclosure must be that rounding of F alone makes wide, so that there is room for the rest.
const ROOM: f64 = 1.1;

/// Beams of so many columns and rows are not cut just since not all of their rays have a root.
const SMALL: usize = 8;

/// Of beams of more columns or rows only the corners are asked whether they hit.
const LARGEST_COUNTED: usize = 16;

/// A larger beam is cut when more rays are likely to be followed in vain.
const DOUBTFUL: u32 = 32;

/// Small beams are looked at anew where roots may lie on less than this share of what was looked at.
const SHORT: f64 = 0.5;

/// Rounding that moves roots so many times less than the tolerance does not matter much: an enclosure has room for it on both sides, and half
/// as much is left, for the last step towards a root leaves next to nothing.
const SHARP: f64 = 2.5;

impl Sight {
    /// `None` where nothing is known, or where roundings of F alone make enclosures wider than `tolerance`.
    fn new(form: &Form, tolerance: f64, error: f64) -> Option<Self> {
        let slope = form.slope;
        let least = (1.0 - ROUNDING) * (slope.middle.abs() - slope.radius);
        let blur = (1.0 + ROUNDING) * error / least;
        let unevenness = (1.0 + ROUNDING) * slope.radius / least;
        let length = form.reach.end - form.reach.start;
        (least > 0.0 && 2.0 * ROOM * blur <= tolerance).then(|| Self {
            inverse: 1.0 / slope.middle,
            unevenness,
            turn: form.turn,
            bend: unevenness / length,
            sway: form.sway / (least * length),
            blur,
            tolerance,
        })
    }
}

impl Subdivision<'_> {
    /// Goes on with what is left of a part that was `examined`, on which F is monotone along every ray.
    pub(super) fn follow(&mut self, part: &Part, examined: Span) {
        if self.follow_even(part) || self.follow_edge(part) {
            return;
        }
        let [whole, left] = [examined, part.stretch].map(|span| span.end - span.start);
        if !self.is_small(part) {
            self.divide_beam(part);
        } else if left < SHORT * whole {
            self.examine(&[Cut { beam: part.beam, stretch: part.stretch, slices: 1 }], part.kernels);
        } else {
            self.divide(part);
        }
    }

    /// Follows each ray of a part on which F is monotone with slopes that are much alike, unless too many may be followed in vain; says
    /// whether it did.
    pub(super) fn follow_even(&mut self, part: &Part) -> bool {
        if !part.form.is_even() {
            return false;
        }
        let model = part.form.model(self.beam(part.beam));
        let middle = self.beam(part.beam).area.offset_of_first();
        let start = Start::new(&model, middle, part.stretch);
        let is_followed = self.is_small(part) || self.most_hit(part, &start);
        if is_followed {
            self.follow_each(part, &start);
        }
        is_followed
    }

    fn is_small(&self, part: &Part) -> bool {
        self.size(part) <= SMALL
    }

    /// Whether few rays of a part may have a root, but are likely to have none. Of large parts only the corners are asked.
    fn most_hit(&self, part: &Part, start: &Start<'_>) -> bool {
        let area = self.beam(part.beam).area;
        let are_sure = start.is_sure_of(area);
        if are_sure || area.side() > LARGEST_COUNTED {
            return are_sure;
        }
        let doubtful = |sum: u32, row: usize| {
            let (likely, sure) =
                (start.likely((area.column, row), area.width), start.sure((area.column, row), area.width));
            let count = |Range { start, end }: Range<usize>| {
                self.memory.open.in_row(row, area.column + start..area.column + end).count_ones()
            };
            let of_row = match sure.is_empty() {
                true => count(likely),
                false => count(likely.start..sure.start) + count(sure.end..likely.end),
            };
            Some(sum + of_row).filter(|sum| *sum <= DOUBTFUL)
        };
        area.rows().try_fold(0, doubtful).is_some()
    }

    /// Ends or goes on with each ray of a part by its root there.
    fn follow_each(&mut self, part: &Part, start: &Start<'_>) {
        let Some(sight) = self.sight(part) else {
            let is_smallest = self.size(part) <= SMALLEST;
            return if is_smallest { self.search_each(part) } else { self.divide_beam(part) };
        };
        let area = self.beam(part.beam).area;
        let are_likely = start.is_sure_of(area);
        let mut sheaf = std::mem::take(&mut self.memory.sheaf);
        for row in area.rows() {
            for Range { start: first, end } in together(area.columns()) {
                let likely =
                    if are_likely { 0..end - first } else { start.likely((first, row), end - first) };
                let (first, end) = (first + likely.start, first + likely.end);
                if sheaf.room() < likely.len() {
                    self.pursue_sheaf(&mut sheaf, part, (start, &sight));
                }
                sheaf.add((first, row), self.memory.open.in_row(row, first..end));
            }
        }
        self.pursue_sheaf(&mut sheaf, part, (start, &sight));
        self.memory.sheaf = sheaf;
    }

    /// Ends or goes on with each ray of a sheaf. Those that may have a root so near to a face of the region that no point inside is known
    /// are searched each for its own.
    fn pursue_sheaf(&mut self, sheaf: &mut Sheaf, part: &Part, (start, sight): (&Start<'_>, &Sight)) {
        let bundles = sheaf.take();
        if !part.is_inside {
            for bundle in &mut *bundles {
                bundle.look_along(part.stretches());
                bundle.clip(|column, row| self.clipped(part, (column, row)));
            }
        }
        self.pursue_bundles(bundles, part, (start, sight));
        for bundle in &*bundles {
            if let (true, Some(normals)) = (bundle.lacks_normals, &self.normals) {
                let function = || self.kernels[part.kernels as usize].identity();
                let asked = bundle.without_normals(normals);
                asked.for_each(|asked| self.memory.met.push(part.kernels, function, asked));
            }
            if let Some(first) = bundle.first_of_hits() {
                self.end_neighbours(first, &bundle.root, &bundle.bracket);
                continue;
            }
            bundle.hits().for_each(|(place, hit)| self.end(place, Outcome::Hit(hit)));
            for (place, stretch) in bundle.lost() {
                self.search_one(self.position(place), stretch, part.known());
            }
        }
    }

    /// Follows the rays of no more than [`AT_ONCE`](super::pursuit::AT_ONCE) bundles.
    fn pursue_bundles(&mut self, bundles: &mut [Bundle], part: &Part, (start, sight): (&Start<'_>, &Sight)) {
        let (kernels, area) = (part.kernels, self.beam(part.beam).area);
        let common = part.is_inside.then(|| part.stretches());
        let Workspace { arch, point_rows, scratch, counters, .. } = &mut *self.workspace;
        let of_part = &self.kernels[kernels as usize];
        let kernel_of_last = if self.normals.is_some() { Kernel::Gradients } else { Kernel::Values };
        let kernel = of_part.over_points(kernel_of_last);
        let last = match &mut self.normals {
            Some(normals) => Last::Gradient(kernel, normals),
            None => Last::Value(kernel),
        };
        let slopes = of_part.over_points(Kernel::Slopes);
        let (tile, points) = (&self.tile, point_rows);
        let taken = arch.dispatch(Pursuit {
            tile,
            area,
            start,
            bundles,
            common,
            sight,
            slopes,
            last,
            points,
            scratch,
        });
        counters.trace_evaluations += (taken.slopes + taken.last) as u64;
        if self.normals.is_some() {
            counters.gradient_evaluations += taken.last as u64;
        }
        counters.operations += of_part.charge(Kernel::Slopes, taken.slopes);
        counters.operations += of_part.charge(kernel_of_last, taken.last);
    }

    /// What values say over a part. `None` when rounding is not bounded there, or too much to enclose roots as narrowly as is wanted.
    fn sight(&mut self, part: &Part) -> Option<Sight> {
        let form = &part.form;
        let tolerance = self.tolerance(part);
        let bounds = self.beam(part.beam).bounds(form.reach, &self.certified.region)?;
        let sight =
            |rounding: &Rounding, beam: &Beam| Sight::new(form, tolerance, rounding.error(beam, form.reach));
        // A bound on a larger box will do as long as it is little beside what is wanted. If none is, less of the stretch is looked at along a
        // single ray where its root is, and rounding may be less there.
        let is_little = |rounding: &Rounding, beam: &Beam| {
            sight(rounding, beam).is_some_and(|sight| SHARP * sight.blur < tolerance)
        };
        let rounding = self.rounding((part.beam, part.kernels), bounds, is_little)?;
        sight(&rounding, self.beam(part.beam))
    }

    /// Where a ray may have its root inside the region, and where the part's certificate holds there. `None` when it has none, or was
    /// searched.
    fn clipped(&mut self, part: &Part, (column, row): (usize, usize)) -> Option<[Span; 2]> {
        let Clip { outer, inner } = Clip::new(&self.certified.region, &self.tile.ray(column, row))?;
        let (wanted, reach) = (common(part.stretch, outer), common(part.form.reach, inner));
        if wanted.start > wanted.end {
            return None;
        }
        if reach.start > reach.end {
            self.search_one((column, row), wanted, part.known());
            return None;
        }
        Some([wanted, reach])
    }
}

/// What is in both; it ends before it starts when nothing is.
fn common(a: Span, b: Span) -> Span {
    Span { start: a.start.max(b.start), end: a.end.min(b.end) }
}
