// Lists of cells that are work of their own, from adapt to cast. They share a buffer: a third each.

// Sampled as a whole; in some of their bricks, or more coarsely along the rays; and nowhere, though some of their
// bricks follow slopes.
const WHOLES: u32 = 0u;
const PARTS: u32 = 1u;
const SLOPED: u32 = 2u;
const LISTS: u32 = 3u;
// Where it is counted how many cells are on any list, behind the numbers of those on each.
const LISTED: u32 = 3u;

// Where entry `number` of a list stands in a buffer with room for so many.
fn place_in_list(list: u32, number: u32, room: u32) -> u32 {
    return list * (room / LISTS) + number;
}
