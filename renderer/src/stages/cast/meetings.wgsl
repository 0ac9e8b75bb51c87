// Which of the particles in shared memory reach which rays. Eight lanes, 4 × 2 rays, have a list of their own: they
// go through those particles alone that may reach one of them where it is sampled.

const BLOCKS: u32 = 8u;
const BLOCK_LANES: u32 = LANES / BLOCKS;
// No ray of a block is farther from its axis than √(1.5² + 0.5²) pixels.
const BLOCK_REACH: f32 = 1.5812;
// Balls and blocks are taken to be larger by so much, for rounding.
const MEETING_SLACK: f32 = 1.0001;

// Bits of the blocks that each particle meets, four particles a word; and turned about, of the particles that each
// block meets, two words each.
var<workgroup> met_by_particles: array<atomic<u32>, 16>;
var<workgroup> met_by_blocks: array<atomic<u32>, 16>;
// Bits of the brick layers in which a ray of each block is sampled, where not all are.
var<workgroup> wanted_layers: array<atomic<u32>, BLOCKS>;

// `layers`: bits of those that the lane samples.
fn want_layers(layers: u32, lane: u32) {
    if !SOME_SHOWN {
        return;
    }
    if lane < BLOCKS {
        atomicStore(&wanted_layers[lane], 0u);
    }
    workgroupBarrier();
    atomicOr(&wanted_layers[lane / BLOCK_LANES], layers);
}

fn layers_wanted_by(block: u32) -> u32 {
    if SOME_SHOWN {
        return atomicLoad(&wanted_layers[block]);
    }
    return ALL_BRICKS;
}

fn clear_met(lane: u32) {
    if lane < 16u {
        atomicStore(&met_by_particles[lane], 0u);
        atomicStore(&met_by_blocks[lane], 0u);
    }
}

// The axis of a block, in slope from that of the bundle.
fn block_from_axis(block: u32) -> vec2<f32> {
    let place = vec2<f32>(place_in_bundle(block * BLOCK_LANES));
    return vec2(place.x - 2.0, 3.0 - place.y) * frame.pitch;
}

// Whether a particle may reach a ray of a block in any of these layers: it lies beside a stretch of the block's axis.
fn may_meet(ball: vec4<f32>, axis: vec2<f32>, block: u32, layers: u32) -> bool {
    if layers == 0u {
        return false;
    }
    let first = frame.sample_offset[firstTrailingBit(layers)].x;
    let last = frame.sample_offset[firstLeadingBit(layers)].w;
    let from_axis = block_from_axis(block);
    let direction = vec3(axis + from_axis, 1.0);
    let offset = ball.xyz - vec3(from_axis, 0.0);
    let along = dot(offset, direction) / dot(direction, direction);
    let closest = offset - clamp(along, first, last) * direction;
    let reach = (inverseSqrt(ball.w) + BLOCK_REACH * frame.pitch * (1.0 + last)) * MEETING_SLACK;
    return dot(closest, closest) < reach * reach;
}

// Notes the blocks that the lane's particle may meet.
fn note_met(ball: vec4<f32>, axis: vec2<f32>, lane: u32) {
    var blocks = 0u;
    for (var block = 0u; block < BLOCKS; block += 1u) {
        blocks |= select(0u, 1u << block, may_meet(ball, axis, block, layers_wanted_by(block)));
    }
    atomicOr(&met_by_particles[lane / 4u], blocks << (lane % 4u * BLOCKS));
}

// Which of the four particles of a word meet a block, as bits: the lowest bits of its bytes, brought together.
fn four_met(word: u32, block: u32) -> u32 {
    return ((atomicLoad(&met_by_particles[word]) >> block & 0x01010101u) * 0x01020408u) >> 24u;
}

// Makes the lists of blocks from those of particles: a lane eight particles of its block.
fn turn_met(lane: u32) {
    let block = lane / BLOCK_LANES;
    let eighth = lane % BLOCK_LANES;
    let eight = four_met(2u * eighth, block) | four_met(2u * eighth + 1u, block) << 4u;
    atomicOr(&met_by_blocks[2u * block + eighth / 4u], eight << (eighth % 4u * 8u));
}

// The list of the lane's block, as bits.
fn met_by(lane: u32) -> vec2<u32> {
    let block = lane / BLOCK_LANES;
    return vec2(atomicLoad(&met_by_blocks[2u * block]), atomicLoad(&met_by_blocks[2u * block + 1u]));
}
