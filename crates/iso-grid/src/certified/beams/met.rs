//! Hits whose normals are still to be found, by the functions that have them.

use crate::normals::Asked;

/// The hits of a tile, those of each function in the order in which they were found.
#[derive(Debug, Default)]
pub(crate) struct Met {
    /// The functions, by their identities, each with the number of kernels of it.
    functions: Vec<(usize, u32)>,
    /// The hits of each. There may be more lists, kept for their memory.
    hits: Vec<Vec<Asked>>,
    /// The place of the function of kernels among those, by their number, where it was found before.
    places: Vec<Option<u32>>,
}

impl Met {
    pub(super) fn clear(&mut self) {
        self.functions.clear();
        self.places.clear();
    }

    /// Notes a hit of a function that has kernels of this number, by its identity.
    #[inline]
    pub(super) fn push(&mut self, kernels: u32, function: impl FnOnce() -> usize, asked: Asked) {
        let known = self.places.get(kernels as usize).copied().flatten();
        let place = known.unwrap_or_else(|| self.place(kernels, function()));
        self.hits[place as usize].push(asked);
    }

    /// The place of a function of this identity, which has kernels of this number.
    #[cold]
    fn place(&mut self, kernels: u32, function: usize) -> u32 {
        let known = self.functions.iter().position(|(known, _)| *known == function);
        let place = known.unwrap_or_else(|| {
            let place = self.functions.len();
            self.functions.push((function, kernels));
            match self.hits.get_mut(place) {
                Some(hits) => hits.clear(),
                None => self.hits.push(Vec::new()),
            }
            place
        });
        let count = self.places.len().max(kernels as usize + 1);
        self.places.resize(count, None);
        self.places[kernels as usize] = Some(place as u32);
        place as u32
    }

    /// The hits of each function, with the number of kernels that give their normals.
    pub(super) fn by_function(&self) -> impl Iterator<Item = (u32, &[Asked])> {
        self.functions.iter().zip(&self.hits).map(|((_, kernels), hits)| (*kernels, &hits[..]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers of kernels, and the places of the hits of each.
    fn hits(met: &Met) -> Vec<(u32, Vec<usize>)> {
        met.by_function()
            .map(|(kernels, hits)| (kernels, hits.iter().map(|hit| hit.place).collect()))
            .collect()
    }

    #[test]
    fn hits_stand_with_their_functions_and_those_of_an_earlier_tile_are_gone() {
        let mut met = Met::default();
        let asked = |place| Asked { place, t: 1.0 };
        for (function, kernels, place) in [(7, 1, 0), (9, 2, 1), (7, 3, 2), (8, 4, 3), (9, 2, 4)] {
            met.push(kernels, || function, asked(place));
        }
        // A number tells the function.
        met.push(2, || unreachable!(), asked(5));
        assert_eq!(hits(&met), [(1, vec![0, 2]), (2, vec![1, 4, 5]), (4, vec![3])]);
        met.clear();
        assert_eq!(hits(&met), []);
        // Numbers mean other kernels now.
        met.push(2, || 8, asked(6));
        met.push(5, || 9, asked(7));
        assert_eq!(hits(&met), [(2, vec![6]), (5, vec![7])]);
    }
}
