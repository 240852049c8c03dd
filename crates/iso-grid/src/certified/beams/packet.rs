//! Packets: rays of a part that are looked at side by side.

use pulp::Simd;

use super::open_rays::{OpenRays, columns_of, together};
use crate::area::Area;
use crate::lanes::{Lanes, ROW, Row};
use crate::raster::RayRow;
use crate::{Span, Tile};

/// Larger areas are first looked at in blocks of so many columns and rows.
const BLOCK: usize = 4;

/// Some rays of a tile.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Packet {
    count: usize,
    /// Which rays they are, or of some that are looked at together.
    places: [u32; ROW],
    columns: Row,
    rows: Row,
}

/// What has a sign on rays of a part.
pub(super) trait Signed {
    /// The signs on all rays no more than `radii` columns and rows from those that are so many off the middle of the part: 0 where they are not
    /// known.
    fn signs<S: Simd>(&self, simd: S, middle: &[Row; 2], radii: &[Row; 2]) -> Row;
}

impl Packet {
    /// Adds the ray of a place, in a column and a row, to a packet that is not full.
    pub(super) fn push(&mut self, place: usize, (column, row): (usize, usize)) {
        self.places[self.count] = place as u32;
        (self.columns[self.count], self.rows[self.count]) = (column as f64, row as f64);
        self.count += 1;
    }

    /// Puts one of the rays into other packets.
    pub(super) fn put_into(&self, packets: &mut Vec<Self>, lane: usize) {
        let packet = with_room(packets);
        packet.places[packet.count] = self.places[lane];
        packet.columns[packet.count] = self.columns[lane];
        packet.rows[packet.count] = self.rows[lane];
        packet.count += 1;
    }

    /// The places of the rays.
    pub(super) fn places(&self) -> impl Iterator<Item = usize> {
        self.places[..self.count].iter().map(|place| *place as usize)
    }

    /// Their columns and rows.
    pub(super) fn positions(&self) -> impl Iterator<Item = (usize, usize)> {
        let rays = self.columns.iter().zip(&self.rows).take(self.count);
        rays.map(|(column, row)| (*column as usize, *row as usize))
    }

    /// How many columns and rows the rays are off the middle of an area.
    #[inline(always)]
    pub(super) fn offsets<S: Simd>(&self, (simd, part): (S, usize), area: Area) -> [Lanes<S>; 2] {
        let (column, row) = area.offset_of_first();
        let from = |rows: &Row, middle: f64| Lanes::of(simd, rows, part) - Lanes::all(simd, middle);
        [from(&self.columns, column), from(&self.rows, row)]
    }

    /// The rays themselves.
    #[inline(always)]
    pub(super) fn rays<S: Simd>(&self, simd: S, tile: &Tile<'_>) -> RayRow {
        tile.row(simd, &self.columns, &self.rows)
    }

    /// The number for each ray, and another one where there is none.
    pub(super) fn each(&self, number: f64, other: f64) -> Row {
        std::array::from_fn(|lane| if lane < self.count { number } else { other })
    }
}

/// The last packet, or a new one where that is full.
fn with_room(packets: &mut Vec<Packet>) -> &mut Packet {
    if packets.last().is_none_or(|packet| packet.count == ROW) {
        packets.push(Packet::default());
    }
    let last = packets.len() - 1;
    &mut packets[last]
}

/// A stretch for all rays of a packet.
pub(super) fn for_all(Span { start, end }: Span) -> [Row; 2] {
    [[start; ROW], [end; ROW]]
}

/// The rays of an area of a tile that are still followed.
pub(super) struct OpenArea<'a> {
    pub(super) area: Area,
    pub(super) open: &'a OpenRays,
}

impl OpenArea<'_> {
    /// Puts them into packets, but for those of blocks on which something is of one sign.
    #[inline(always)]
    pub(super) fn pack<S: Simd>(&self, simd: S, of: &impl Signed, packets: &mut Vec<Packet>) {
        packets.clear();
        if self.area.side() <= BLOCK {
            return self.pack_block(self.area, packets);
        }
        let mut blocks = self.area.blocks(BLOCK);
        let mut some = [self.area; ROW];
        loop {
            let (mut middle, mut radii, mut count) = ([[0.0; ROW]; 2], [[0.0; ROW]; 2], 0);
            for (lane, block) in blocks.by_ref().take(ROW).enumerate() {
                let (column, row) = self.area.offset(block.column, block.row);
                let [across, along] = block.radii();
                (middle[0][lane], middle[1][lane]) = (column + across, row + along);
                (radii[0][lane], radii[1][lane]) = (across, along);
                some[lane] = block;
                count = lane + 1;
            }
            if count == 0 {
                break;
            }
            let signs = of.signs(simd, &middle, &radii);
            for (block, sign) in some[..count].iter().zip(signs) {
                if sign == 0.0 {
                    self.pack_block(*block, packets);
                }
            }
        }
    }

    fn pack_block(&self, block: Area, packets: &mut Vec<Packet>) {
        for row in block.rows() {
            for columns in together(block.columns()) {
                for column in columns_of(columns.start, self.open.in_row(row, columns)) {
                    with_room(packets).push(row * self.open.width() + column, (column, row));
                }
            }
        }
    }
}
