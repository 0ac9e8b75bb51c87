// What a stretch of a few rays through one brick can do to the light behind it.
//
// A brick is the rays of a column × 4 slices; the columns of a cell are 4 deep.
//
// A brick's values are two numbers, bounds of the quantity at all its samples, in [0, 1]; COVERED is
// added to the upper one where every sample meets a particle. Where no sample meets one, they are
// EMPTY: a state of its own, never inverted bounds.

const BRICK_DEPTH: u32 = 4u;
const EMPTY: vec2<f32> = vec2(-1.0, -1.0);
const COVERED: f32 = 2.0;
const FAR: f32 = 1e30;

// Values of a column's bricks, components from front to back; and how the quantity runs through each of
// them, as far as it is linear.
struct ColumnValues {
    low: vec4<f32>,
    high: vec4<f32>,
    // In the middle; from there to the right and to the upper side, and to the back: pairs of half floats
    // (pack_slope). The last pair ends with how far the quantity may be off.
    middle: vec4<f32>,
    across: vec4<u32>,
    along: vec4<u32>,
}

// Bricks are taken to be larger by so much, for rounding. Bounds and slopes measure with the same brick.
const SLACK: f32 = 1.0001;

// Slopes are kept so many times as large: where half floats are less than 2⁻¹⁴, devices may take them for 0.
const SLOPE_UNIT: f32 = 4096.0;
// No two quantities in [0, 1] are as far apart.
const WIDEST: f32 = 2.0;

fn pack_slope(pair: vec2<f32>) -> u32 {
    return pack2x16float(SLOPE_UNIT * pair);
}

fn unpack_slope(pair: u32) -> vec2<f32> {
    return unpack2x16float(pair) / SLOPE_UNIT;
}

fn no_values() -> ColumnValues {
    let none = vec4(EMPTY.x);
    return ColumnValues(none, none, vec4(0.0), vec4(0u), vec4(0u));
}

// The quantity at a ray's samples in a brick, by the brick's slope. `ray`: its number in the column.
fn values_on_slope(values: ColumnValues, brick: u32, ray: u32) -> vec4<f32> {
    let depths = frame.sample_offset[brick];
    let place = vec2<f32>(place_in_bundle(ray));
    let side = vec2(place.x - HALF_COLUMN, HALF_COLUMN - place.y) / HALF_COLUMN;
    let aside = (1.0 + depths) / ((1.0 + depths.w) * SLACK);
    let behind = (2.0 * depths - depths.x - depths.w) / ((depths.w - depths.x) * SLACK);
    let rise_across = dot(unpack_slope(values.across[brick]), side);
    let rise_along = unpack_slope(values.along[brick]).x;
    let slope = values.middle[brick] + rise_across * aside + rise_along * behind;
    // Nor is the quantity itself anywhere else.
    let high = select(values.high[brick], values.high[brick] - COVERED, values.high[brick] >= COVERED);
    return clamp(slope, vec4(values.low[brick]), vec4(min(high, 1.0)));
}

// Nothing is known of a cell; or only its values as a whole, and that bricks are to be bounded by columns, by sheaves, or
// all as one sheaf.
const UNKNOWN: u32 = 0u;
const BY_COLUMNS: u32 = 1u;
const BY_SHEAVES: u32 = 2u;
const AS_SHEAF: u32 = 3u;
const FIRST_SLOT: u32 = 4u;

// What is known of a cell.
struct CellEntry {
    // Values of the cell as a whole, of the quantity that decides the opacity.
    values: vec2<f32>,
    // Place of its bricks' values + FIRST_SLOT; less where they are not known.
    slot: u32,
    // What became of it in the last choice: the place of its class's counter. Stale, like the masks,
    // where the bundle ended before the cell.
    class_index: u32,
    // Bricks that are sampled at every slice, and those that are at level 2 or follow their slope: bit
    // 16·(b mod 2) + c of word b/2 is brick b of column c.
    sampled: vec2<u32>,
    coarse: vec2<u32>,
}

// Bits of the columns that have any brick in a mask.
fn columns_in(mask: vec2<u32>) -> u32 {
    let both = mask.x | mask.y;
    return (both | both >> 16u) & 0xffffu;
}

// What the analysis found out of a bundle.
struct BundleEntry {
    // The layer after the last one that is seen.
    end_layer: u32,
    // What is charged to the rays of each column.
    charged: array<f32, 16>,
}

// The transfer function over values: its extremes, and how steep it is at most.
struct Shades {
    range: Extremes,
    steepness: vec4<f32>,
}

fn shades_over(values: vec2<f32>) -> Shades {
    // The sum with COVERED may have lost half a unit of its last place.
    let upper = select(values.y, values.y - COVERED + 3e-7, values.y >= COVERED);
    let high = clamp(upper, 0.0, 1.0);
    let low = clamp(values.x, 0.0, high);
    let begin = segment_at(low);
    let end = segment_at(high);
    return Shades(extremes_between(begin, low, end, high), steepness_between(begin, end));
}

// Whether nothing with values in these bounds is seen at all.
fn is_transparent(values: vec2<f32>) -> bool {
    return values.x < 0.0 || shades_over(values).range.high.w == 0.0;
}

struct Hull {
    // The middle of what the brick may show: premultiplied colour, and opacity.
    middle: vec4<f32>,
    // By how much full sampling may differ from that in any channel, whatever lies behind.
    charge: f32,
    // By how much two responses within the hull may differ.
    width: f32,
    // Upper bound of the transparency.
    open: f32,
}

// The hull of a brick with the given values. `transfer`: of the transfer function over them; `paths`: of the
// length of the rays inside, in reference lengths.
//
// With colour c and transparency t between bounds, the response c + t·(b − c) to light b from behind
// has the bounds of `at_black` (b = 0) and `at_white` (b = 1); four slices alike compose to the same
// form with t⁴, so the brick counts as one. The upper bound is convex in b and the lower one concave,
// and the middle is linear, so the two ends decide.
fn hull_of(values: vec2<f32>, transfer: Extremes, paths: vec2<f32>) -> Hull {
    if values.x < 0.0 {
        return Hull(vec4(0.0), 0.0, 0.0, 1.0);
    }
    let covered = values.y >= COVERED;
    let thick = min(path_opacity(transfer.high.w, paths.y) * (1.0 + ROUNDING), 1.0);
    let thin = select(0.0, path_opacity(transfer.low.w, paths.x) * (1.0 - ROUNDING), covered);
    let opacity = 0.5 * (thick + thin);

    let at_black = Band(transfer.low.rgb * thin, transfer.high.rgb * thick);
    let at_white = Band(
        1.0 - thick * (1.0 - transfer.low.rgb),
        1.0 - thin * (1.0 - transfer.high.rgb),
    );
    // A colour that serves both ends best, with the one transparency that all channels share.
    let least = min(at_black.low, at_white.low - (1.0 - opacity));
    let greatest = max(at_black.high, at_white.high - (1.0 - opacity));
    let colour = clamp(0.5 * (least + greatest), vec3(0.0), vec3(opacity));
    let off = max(greatest - colour, colour - least);
    let charge = max(max(off.x, max(off.y, off.z)), 0.5 * (thick - thin));
    let wide = max(at_black.high - at_black.low, at_white.high - at_white.low);
    let width = max(max(wide.x, max(wide.y, wide.z)), thick - thin);
    let seen = thick > 0.0;
    return Hull(vec4(colour, opacity), select(0.0, charge, seen), select(0.0, width, seen), 1.0 - thin);
}

// By how much a brick that follows its slope, `off` by so much, may differ from full sampling; FAR where that
// is not known. One sample c + t·(b − c) changes by at most |Δc|·(1 − t) + |Δt|·|b − c|, and the changes of
// several add up at most; 1 − t ≤ −ln t, which is linear in the path.
fn slope_charge(values: vec2<f32>, shades: Shades, off: f32, path: f32) -> f32 {
    if values.x < 0.0 || values.y < COVERED {
        return FAR;
    }
    let transfer = shades.range;
    let opacity = transfer.high.w;
    let steep = shades.steepness;
    let opaque = opacity > 0.99999 && steep.w > 0.0;
    let by_opacity = select(steep.w / max(1.0 - opacity, 1e-5), FAR, opaque);
    let contrast = max(transfer.high.rgb, 1.0 - transfer.low.rgb);
    let colours = -log_transparency(opacity) * steep.rgb + contrast * by_opacity;
    let most = max(by_opacity, max(colours.x, max(colours.y, colours.z)));
    return min(off * path * most * (1.0 + ROUNDING), FAR);
}

struct Band {
    low: vec3<f32>,
    high: vec3<f32>,
}

// Bounds of the length of a brick's rays inside it, in reference lengths per unit of depth of the
// cell's middle. `slope`: of the column's axis.
fn paths_of(brick_layer: u32, slope: vec2<f32>) -> vec2<f32> {
    let depth = dot(frame.slab_depth[brick_layer], vec4(1.0)) * frame.path_scale;
    let nearest = max(abs(slope) - HALF_COLUMN * frame.pitch, vec2(0.0));
    let farthest = abs(slope) + HALF_COLUMN * frame.pitch;
    let lengths = vec2(length(vec3(nearest, 1.0)), length(vec3(farthest, 1.0)));
    return depth * lengths * vec2(1.0 - ROUNDING, 1.0 + ROUNDING);
}

// The column's axis, in slope from that of the bundle.
fn column_from_axis(column: u32) -> vec2<f32> {
    let place = vec2<f32>(place_in_bundle(column));
    let from_corner = f32(COLUMN_SIDE) * place - 0.5 * f32(BUNDLE_SIDE - COLUMN_SIDE);
    return vec2(from_corner.x, -from_corner.y) * frame.pitch;
}

// Whether any ray of a column belongs to the picture.
fn column_in_picture(corner: vec2<f32>, column: u32) -> bool {
    return all(corner + f32(COLUMN_SIDE) * vec2<f32>(place_in_bundle(column)) < vec2<f32>(frame.size));
}
