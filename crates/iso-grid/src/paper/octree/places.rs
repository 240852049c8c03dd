//! Maps and sets of places.

use std::collections::{HashMap, HashSet};
use std::hash::{BuildHasherDefault, Hasher};

/// Values by place.
pub(super) type PlaceMap<V> = HashMap<[usize; 3], V, BuildHasherDefault<PlaceHasher>>;
/// A set of places.
pub(super) type PlaceSet = HashSet<[usize; 3], BuildHasherDefault<PlaceHasher>>;

/// Fibonacci hashing (D. Knuth, The Art of Computer Programming, volume 3, section 6.4), coordinate by coordinate. Places
/// come from a lattice, not from someone who wants them to collide, and millions of them are hashed.
#[derive(Default)]
pub(super) struct PlaceHasher(u64);

/// 2⁶⁴ divided by the golden ratio, made odd.
const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

impl Hasher for PlaceHasher {
    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.0 = (self.0.rotate_left(23) ^ u64::from_le_bytes(word)).wrapping_mul(GOLDEN);
        }
    }

    fn finish(&self) -> u64 {
        // The product's high bits are the mixed ones; a map looks at the low ones first.
        self.0 ^ (self.0 >> 32)
    }
}
