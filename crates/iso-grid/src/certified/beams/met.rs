//! Hits whose normals are still to be found, by the functions that have them.

use crate::normals::Asked;

/// The hits of a tile, those of each function in the order in which they were found.
#[derive(Debug, Default)]
pub(crate) struct Met {
    /// The functions, by their identities, each with the number of kernels of it.
    functions: Vec<(usize, u32)>,
    /// The hits of each. There may be more lists, kept for their memory.
    hits: Vec<Vec<Asked>>,
}

impl Met {
    pub(super) fn clear(&mut self) {
        self.functions.clear();
    }

    /// Notes a hit of a function of this identity, which has kernels of this number.
    pub(super) fn push(&mut self, (function, kernels): (usize, u32), asked: Asked) {
        // Those that are met come late in the list, for neighbours meet the same.
        let known = self.functions.iter().rposition(|(known, _)| *known == function);
        let place = known.unwrap_or_else(|| {
            let place = self.functions.len();
            self.functions.push((function, kernels));
            match self.hits.get_mut(place) {
                Some(hits) => hits.clear(),
                None => self.hits.push(Vec::new()),
            }
            place
        });
        self.hits[place].push(asked);
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
            met.push((function, kernels), asked(place));
        }
        assert_eq!(hits(&met), [(1, vec![0, 2]), (2, vec![1, 4]), (4, vec![3])]);
        met.clear();
        assert_eq!(hits(&met), []);
        met.push((9, 5), asked(6));
        assert_eq!(hits(&met), [(5, vec![6])]);
    }
}
