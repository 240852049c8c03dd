//! Maps and sets of places on a lattice, which are named by their index.

use std::collections::{HashMap, HashSet};
use std::hash::{BuildHasherDefault, Hasher};

/// Values by place.
pub(super) type PlaceMap<V> = HashMap<usize, V, BuildHasherDefault<PlaceHasher>>;
/// A set of places.
pub(super) type PlaceSet = HashSet<usize, BuildHasherDefault<PlaceHasher>>;

/// Fibonacci hashing (D. Knuth, The Art of Computer Programming, volume 3, section 6.4). Places come from a lattice, not
/// from someone who wants them to collide, and millions of them are hashed.
#[derive(Default)]
pub(super) struct PlaceHasher(u64);

/// 2⁶⁴ divided by the golden ratio, made odd.
const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

impl Hasher for PlaceHasher {
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_usize(usize::from(byte));
        }
    }

    fn write_usize(&mut self, place: usize) {
        self.0 = (self.0 ^ place as u64).wrapping_mul(GOLDEN);
    }

    fn finish(&self) -> u64 {
        // The product's high bits are the mixed ones; a map looks at the low ones first.
        self.0 ^ (self.0 >> 32)
    }
}
