//! The pixels of a layer.

use std::fmt;
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut};

use bytemuck::allocation::try_zeroed_vec;
use bytemuck::{Pod, cast_slice, cast_slice_mut};
use memmap2::MmapMut;

/// The pixels of a layer, row by row: a slice.
///
/// Those of large pictures lie in pages of their own, large ones where the system has them, for to touch new memory in small
/// pages for the first time takes longer than to draw a simple surface.
#[derive(Clone)]
pub struct Layer<T: Pod>(Memory<T>);

enum Memory<T> {
    Heap(Vec<T>),
    Pages(MmapMut, PhantomData<T>),
}

/// So many bytes are worth pages of their own: a few large ones.
const LARGE: usize = 1 << 23;

impl<T: Pod> Layer<T> {
    /// Gives it so many pixels, which mean nothing, and keeps its memory where it has as many; `None` when memory does not
    /// suffice.
    pub(crate) fn make_room(&mut self, pixels: usize) -> Option<()> {
        if self.len() != pixels {
            *self = Self::default();
            *self = Self::zeroed(pixels)?;
        }
        Some(())
    }

    /// So many pixels of zeros, which threads touch first that write to them; `None` when memory does not suffice.
    fn zeroed(pixels: usize) -> Option<Self> {
        let bytes = pixels.checked_mul(size_of::<T>())?;
        if bytes < LARGE {
            return Some(Self(Memory::Heap(try_zeroed_vec(pixels).ok()?)));
        }
        let pages = MmapMut::map_anon(bytes).ok()?;
        // Small pages do as well, only slower.
        #[cfg(target_os = "linux")]
        let _ = pages.advise(memmap2::Advice::HugePage);
        Some(Self(Memory::Pages(pages, PhantomData)))
    }
}

impl<T: Pod> Deref for Layer<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        match &self.0 {
            Memory::Heap(pixels) => pixels,
            Memory::Pages(bytes, _) => cast_slice(bytes),
        }
    }
}

impl<T: Pod> DerefMut for Layer<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        match &mut self.0 {
            Memory::Heap(pixels) => pixels,
            Memory::Pages(bytes, _) => cast_slice_mut(bytes),
        }
    }
}

impl<T: Pod> Clone for Memory<T> {
    fn clone(&self) -> Self {
        Self::Heap(match self {
            Self::Heap(pixels) => pixels.clone(),
            Self::Pages(bytes, _) => cast_slice(bytes).to_vec(),
        })
    }
}

/// No pixels: a layer that is not kept.
impl<T: Pod> Default for Layer<T> {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl<T: Pod> From<Vec<T>> for Layer<T> {
    fn from(pixels: Vec<T>) -> Self {
        Self(Memory::Heap(pixels))
    }
}

impl<T: Pod> FromIterator<T> for Layer<T> {
    fn from_iter<I: IntoIterator<Item = T>>(pixels: I) -> Self {
        Vec::from_iter(pixels).into()
    }
}

impl<T: Pod + PartialEq> PartialEq for Layer<T> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<T: Pod + fmt::Debug> fmt::Debug for Layer<T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_list().entries(self.iter()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_of_any_size_are_zeroed_slices() {
        for pixels in [0, 1, 1000, LARGE / 3 + 1, LARGE] {
            let mut layer = Layer::<[u8; 3]>::zeroed(pixels).unwrap();
            assert_eq!(layer.len(), pixels);
            assert!(layer.iter().all(|pixel| *pixel == [0; 3]));
            if let Some(last) = layer.last_mut() {
                *last = [1, 2, 3];
                assert_eq!(layer.clone(), layer);
                assert_ne!(layer, Layer::zeroed(pixels).unwrap());
            }
        }
        assert!(Layer::<f64>::zeroed(usize::MAX / 2).is_none());
        assert!(Layer::<f64>::zeroed(1 << 58).is_none());
    }
}
