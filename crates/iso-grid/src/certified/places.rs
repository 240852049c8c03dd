//! Kernels by place: where a box decides branches of F, what is left of F is kept for all rays that come by.

use std::sync::{Arc, RwLock};

use glam::DVec3;
use iso_expr::{Composition, Interval};
use rustc_hash::FxHashMap;

use super::formula::Formulas;
use super::kernels::{Bounds, Kernels, bounds_between};
use crate::Region;

/// How often the region is halved along each axis at most.
const DEEPEST: u32 = 6;

/// A place holds what lies in it however that is rounded: it is larger at each side by this part of its size.
const MARGIN: f64 = 1.0 / (1u64 << 32) as f64;

/// What F comes to in parts of the region, found out when it is first asked for.
///
/// The places of a level are boxes twice as long as the steps between them, so that whatever is no longer than a step lies in
/// one of them. Each lies in one of the level above, from whose program its own is made. What a place holds depends on the
/// surface and the place alone.
pub(super) struct Places {
    whole: Arc<Kernels>,
    min: DVec3,
    extent: DVec3,
    /// Whether all is done with the whole formula.
    are_ignored: bool,
    known: RwLock<FxHashMap<Place, Arc<Kernels>>>,
    formulas: Formulas,
}

/// One of a level's overlapping boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Place {
    /// How often the region is halved for one step.
    level: u32,
    /// How many steps along each axis it begins after the region.
    steps: [u32; 3],
}

impl Place {
    const REGION: Self = Self { level: 0, steps: [0; 3] };

    /// A place of the level above around all of this one.
    fn parent(self) -> Option<Self> {
        let level = self.level.checked_sub(1)?;
        Some(Self { level, steps: self.steps.map(|steps| steps / 2) })
    }
}

impl Places {
    pub(super) fn new(whole: &Arc<Kernels>, region: &Region) -> Self {
        Self {
            whole: Arc::clone(whole),
            min: region.min(),
            extent: region.max() - region.min(),
            are_ignored: false,
            known: RwLock::default(),
            formulas: Formulas::default(),
        }
    }

    /// None at all: the kernels are everywhere those of the whole formula.
    pub(super) fn ignored(self) -> Self {
        Self { are_ignored: true, ..self }
    }

    /// Whether formulas may be shorter in some places.
    pub(super) fn are_asked(&self) -> bool {
        self.whole.may_be_shortened() && !self.are_ignored
    }

    /// Kernels that hold on a box in the region: the shortest known.
    pub(super) fn kernels(&self, lo: DVec3, hi: DVec3) -> Arc<Kernels> {
        if !self.are_asked() {
            return Arc::clone(&self.whole);
        }
        let found = self.at(self.around(lo, hi));
        if found.cover(&bounds_between(lo, hi)) { found } else { Arc::clone(&self.whole) }
    }

    /// Kernels of the functions that F is made of wherever some kernels hold, if it has kinks there.
    pub(super) fn composition<'a>(&self, kernels: &'a Kernels) -> Option<&'a Composition<Arc<Kernels>>> {
        kernels.composition(&self.formulas)
    }

    /// The smallest place that a box lies in.
    fn around(&self, lo: DVec3, hi: DVec3) -> Place {
        let longest = ((hi - lo) / self.extent).max_element();
        let fitting = (-longest.log2()).floor();
        let level =
            if fitting > 0.0 { fitting.min(f64::from(DEEPEST)) as u32 } else { return Place::REGION };
        let steps = (lo - self.min) / self.extent * f64::from(1u32 << level);
        Place { level, steps: steps.to_array().map(|steps| steps as u32) }
    }

    /// What is known at a place, or can be found out.
    fn at(&self, place: Place) -> Arc<Kernels> {
        let mut missing = Vec::new();
        let mut next = Some(place);
        let mut found = loop {
            let Some(place) = next else { break Arc::clone(&self.whole) };
            let known = self.known.read().expect("no thread panics while it holds the map");
            if let Some(found) = known.get(&place) {
                break Arc::clone(found);
            }
            missing.push(place);
            next = place.parent();
        };
        for place in missing.into_iter().rev() {
            found = self.find_out(place, found);
        }
        found
    }

    /// What F comes to at a place in one where it comes to `outer`.
    fn find_out(&self, place: Place, outer: Arc<Kernels>) -> Arc<Kernels> {
        let shortened =
            if outer.may_be_shortened() { outer.shortened(&self.formulas, self.bounds(place)) } else { None };
        let found = shortened.map_or(outer, Arc::new);
        // Without room it is found out anew each time: no result depends on what is kept.
        if !self.formulas.have_room() {
            return found;
        }
        let mut known = self.known.write().expect("no thread panics while it holds the map");
        Arc::clone(known.entry(place).or_insert(found))
    }

    /// The box of a place, with a margin.
    fn bounds(&self, place: Place) -> Bounds {
        let step = self.extent / f64::from(1u32 << place.level);
        [0, 1, 2].map(|axis| {
            let lo = self.min[axis] + f64::from(place.steps[axis]) * step[axis];
            let hi = lo + 2.0 * step[axis];
            let margin = MARGIN * (step[axis] + lo.abs().max(hi.abs()));
            Interval { lo: lo - margin, hi: hi + margin }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::surface_of;

    /// Two balls beside each other: in places of one, the other is left out.
    fn kernels() -> Arc<Kernels> {
        let formula = "min((x - 1)^2 + y^2 + z^2 - 0.2, (x + 1)^2 + y^2 + z^2 - 0.2)";
        Arc::new(Kernels::of(&surface_of(formula)).unwrap())
    }

    fn places() -> Places {
        Places::new(&kernels(), &Region::new(DVec3::splat(-2.0), DVec3::splat(2.0)).unwrap())
    }

    /// As when two threads come to a place at once.
    #[test]
    fn what_is_found_out_twice_is_kept_once() {
        let places = places();
        let place = places.around(DVec3::new(1.1, -0.1, -0.1), DVec3::new(1.2, 0.1, 0.1));
        let [first, second] = [(); 2].map(|()| places.find_out(place, Arc::clone(&places.whole)));
        assert!(first.program().operations() < places.whole.program().operations());
        assert!(Arc::ptr_eq(&first, &second));
        assert!(Arc::ptr_eq(&first, &places.at(place)));
    }

    #[test]
    fn kernels_found_out_anew_are_known_again() {
        let (places, elsewhere) = (places(), places());
        let at =
            |places: &Places, x: f64| places.kernels(DVec3::new(x, 0.0, 0.0), DVec3::new(x + 0.1, 0.1, 0.1));
        assert!(at(&places, 1.1).are(&at(&elsewhere, 1.1)));
        assert!(!at(&places, 1.1).are(&at(&elsewhere, -1.1)));
        let Some(Composition::Extreme(_, faces)) = places.composition(&places.whole) else {
            panic!("no union")
        };
        assert!(faces.iter().all(|face| !face.are(&places.whole)));
    }

    /// Far from the origin margins of small places are larger than the places, so that they may reach out of those around them.
    #[test]
    fn what_is_shorter_holds_no_farther_than_what_it_was_made_of() {
        let around =
            |x: f64, size: f64| [x, 0.0, 0.0].map(|middle| Interval { lo: middle - size, hi: middle + size });
        let (inner, outer) = (around(1.0, 0.1), around(1.0, 0.2));
        let shorter = kernels().within(inner).shortened(&Formulas::default(), outer).unwrap();
        assert!(shorter.cover(&inner) && !shorter.cover(&outer));
    }
}
