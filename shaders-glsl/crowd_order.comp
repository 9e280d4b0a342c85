#version 450
#extension GL_GOOGLE_include_directive : require
// Sorts the visible copies into ranges of depth, and the entries of each tile by depth; makes records and commands. Each
// dispatch makes one pass.
#include "stage/crowd.glsl"

shared uint sums[64];

// Counts the copies of each step of depth.
void count_step(uint n)
{
    atomicAdd(bin_words[step_word(uintBitsToFloat(bin_words[crowd.lists.z + VISIBLE_WORDS * n + 1u]))], 1u);
}

// Joins steps to ranges.
void make_ranges(uint visible)
{
    uint sum = 0u;
    for (uint k = 0u; k < CROWD_STEPS; ++k) {
        uint count = bin_words[head_word(STEPS + k)];
        bin_words[head_word(STEPS + k)] = min(uint(float(sum) / float(visible) * float(CROWD_SLICES)), CROWD_SLICES - 1u);
        sum += count;
    }
}

// Counts the copies of each range.
void slice(uint n)
{
    uint at = crowd.lists.z + VISIBLE_WORDS * n;
    uint range = slice_of(uintBitsToFloat(bin_words[at + 1u]));
    bin_words[at + 4u] = range | count_up(head_word(SLICE_GROUPS + 4u * range), 0xffffffffu) << 5;
}

// Puts the numbers of copies in the order of ranges.
void spread(uint n)
{
    uint word = bin_words[crowd.lists.z + VISIBLE_WORDS * n + 4u];
    bin_words[crowd.order.x + before_slice(word & CROWD_SLICES - 1u) + (word >> 5)] = n;
}

// Finds the first entry of each tile: one work group adds up the counts.
void scan()
{
    uint self = gl_LocalInvocationIndex;
    uint lists = tile_count() * crowd.size.z;
    uint each = (lists + 63u) / 64u;
    uint first = min(self * each, lists);
    uint end = min(first + each, lists);
    uint sum = 0u;
    for (uint k = first; k < end; ++k) {
        sum += bin_words[crowd.lists.x + k];
    }
    sums[self] = sum;
    barrier();
    sum = 0u;
    for (uint k = 0u; k < self; ++k) {
        sum += sums[k];
    }
    for (uint k = first; k < end; ++k) {
        bin_words[crowd.lists.y + k] = sum;
        sum += bin_words[crowd.lists.x + k];
    }
}

const uint RANGE_SHIFT = 26u; // bits of an entry's number, below its range

// Puts the depths, numbers and ranges of entries in the order of tiles. Within a tile they are in the order of ranges,
// in which they were made.
void scatter(uint entry)
{
    uint at = crowd.lists.w + ENTRY_WORDS * entry;
    uint place = bin_words[crowd.lists.y + bin_words[at]] + bin_words[at + 5u];
    uint near = bin_words[at + 2u];
    bin_words[crowd.order.y + 2u * place] = near;
    bin_words[crowd.order.y + 2u * place + 1u] = entry | slice_of(uintBitsToFloat(near)) << RANGE_SHIFT;
}

// Returns 1 if the entry at `place` comes before one of this depth and copy, else 0.
uint precedes(uint place, uint word, uint near, uint number)
{
    uint its = bin_words[crowd.order.y + 2u * place];
    if (its != near) {
        return uint(its < near);
    }
    uint entry = word & (1u << RANGE_SHIFT) - 1u;
    return uint(bin_words[crowd.lists.w + ENTRY_WORDS * entry + 1u] < number);
}

// Puts an entry into the queue of its tile, in the order of depth, and of instances for equal depths. Only entries of its
// own range are compared.
void rank(uint entry)
{
    uint at = crowd.lists.w + ENTRY_WORDS * entry;
    uint list = bin_words[at];
    uint number = bin_words[at + 1u];
    uint near = bin_words[at + 2u];
    uint first = bin_words[crowd.lists.y + list];
    uint end = first + bin_words[crowd.lists.x + list];
    uint own = first + bin_words[at + 5u];
    uint range = bin_words[crowd.order.y + 2u * own + 1u] >> RANGE_SHIFT;
    uint place = own;
    for (uint k = own; k > first; --k) {
        uint word = bin_words[crowd.order.y + 2u * k - 1u];
        if (word >> RANGE_SHIFT != range) {
            break;
        }
        place -= 1u - precedes(k - 1u, word, near, number);
    }
    for (uint k = own + 1u; k < end; ++k) {
        uint word = bin_words[crowd.order.y + 2u * k + 1u];
        if (word >> RANGE_SHIFT != range) {
            break;
        }
        place += precedes(k, word, near, number);
    }
    uint to = crowd.tiles.z + 4u * place;
    tile_words[to] = number;
    tile_words[to + 1u] = near;
    tile_words[to + 2u] = bin_words[at + 3u];
    tile_words[to + 3u] = bin_words[at + 4u];
}

// Returns the first record of a layer, and takes `count` of them.
uint take_records(uint layer, uint count)
{
    return atomicAdd(bin_words[layer_word(layer, LAYER_RECORDS)], count);
}

// Writes the records of a tile of a layer: of four words for fragments, of three for each pixel that shows a copy in
// compute. If there were too many entries, the queue holds all visible copies.
void record(uint list)
{
    uint count = bin_words[crowd.lists.x + list];
    uint first = crowd.tiles.z + 4u * bin_words[crowd.lists.y + list];
    uint layer = list / tile_count();
    bool all = overflows();
    if (count == 0u && !all) {
        return;
    }
    uint tile = list - layer * tile_count();
    uvec2 corner = GROUP_PIXELS * uvec2(tile % crowd.size.x, tile / crowd.size.x);
    uint visible = bin_words[head_word(VISIBLE_GROUPS + 3u)];
    uint near = all ? 0u : tile_words[first + 1u];
    first = all ? crowd.tiles.y : first;
    count = all ? visible | layer << QUEUE_LAYER_SHIFT | QUEUE_UNSORTED : count;
    uint place = corner.x | corner.y << 16;
    uvec2 bits = all ? uvec2(0xffffffffu) : uvec2(bin_words[crowd.order.z + 2u * list], bin_words[crowd.order.z + 2u * list + 1u]);
    if (crowd.tiles.w == 0u) {
        uint at = crowd.tiles.x + 4u * (layer * tile_count() + take_records(layer, 1u));
        uint both = bits.x | bits.y;
        uvec4 halves = uvec4(notEqual(uvec4(both & 0x0f0f0f0fu, both & 0xf0f0f0f0u, bits), uvec4(0u)));
        uint shown = halves.x | halves.y << 1 | halves.z << 2 | halves.w << 3;
        tile_words[at] = tile % crowd.size.x | tile / crowd.size.x << TILE_BITS | shown << RECORD_HALVES_SHIFT;
        tile_words[at + 1u] = first;
        tile_words[at + 2u] = count;
        tile_words[at + 3u] = near;
        return;
    }
    uint number = take_records(layer, uint(bitCount(bits.x) + bitCount(bits.y)));
    uint at = crowd.tiles.x + 3u * (layer * 64u * tile_count() + number);
    for (uint k = 0u; k < 64u; ++k) {
        if (((k < 32u ? bits.x : bits.y) >> (k & 31u) & 1u) != 0u) {
            tile_words[at] = place + (k & 7u | k >> 3 << 16);
            tile_words[at + 1u] = first;
            tile_words[at + 2u] = count;
            at += 3u;
        }
    }
}

// Writes the draw or the dispatch of a layer.
void finish(uint layer)
{
    uint records = bin_words[layer_word(layer, LAYER_RECORDS)];
    uint command = layer_word(layer, LAYER_COMMAND);
    bool in_compute = crowd.tiles.w != 0u;
    uint groups = (records + 63u) / 64u;
    // Most devices dispatch no more groups than this along one axis.
    bin_words[command] = in_compute ? min(groups, MOST_GROUPS) : 6u * records;
    bin_words[command + 1u] = in_compute ? (groups + MOST_GROUPS - 1u) / MOST_GROUPS : 1u;
    bin_words[command + 2u] = in_compute ? 1u : 6u * (crowd.tiles.x / 4u + layer * tile_count());
    bin_words[command + 3u] = 0u;
}

void main()
{
    uint n = 64u * gl_WorkGroupID.x + gl_LocalInvocationIndex;
    uint visible = bin_words[head_word(VISIBLE_GROUPS + 3u)];
    uint entries = min(bin_words[head_word(ENTRY_GROUPS + 3u)], crowd.counts.y);
    if (pushed.bin == CROWD_COUNT && n < visible) {
        count_step(n);
    } else if (pushed.bin == CROWD_RANGES && n == 0u) {
        make_ranges(visible);
    } else if (pushed.bin == CROWD_SLICE && n < visible) {
        slice(n);
    } else if (pushed.bin == CROWD_SPREAD && n < visible) {
        spread(n);
    } else if (pushed.bin == CROWD_SCAN) {
        scan();
    } else if (pushed.bin == CROWD_SCATTER && n < entries) {
        scatter(n);
    } else if (pushed.bin == CROWD_RANK && n < entries) {
        rank(n);
    } else if (pushed.bin == CROWD_RECORDS && n < tile_count() * crowd.size.z) {
        record(n);
    } else if (pushed.bin == CROWD_FINISH && n < crowd.size.z) {
        finish(n);
    }
}
