#version 450
#extension GL_GOOGLE_include_directive : require
// Puts the copies in the picture in order of depth, makes queues of the entries of each tile, and their records and
// commands. Each dispatch makes one pass.
#include "stage/crowd.glsl"

shared uint sums[64];

// Counts the copies before each step and each range, and sets the parts of commands that no copy changes.
void make_ranges()
{
    uint visible = count_of(VISIBLE);
    uint range = 0u;
    uint sum = 0u;
    for (uint k = 0u; k < CROWD_STEPS; ++k) {
        uint count = bin_words[head_word(STEPS + k)];
        bin_words[head_word(STEPS + k)] = sum;
        // A range begins with the first step after its share of the copies.
        float share = float(sum) / float(visible) * float(CROWD_RANGES);
        for (; range < CROWD_RANGES && share >= float(range) && count > 0u; ++range) {
            bin_words[head_word(RANGE_FIRSTS + range)] = sum;
        }
        sum += count;
    }
    for (; range < CROWD_RANGES; ++range) {
        bin_words[head_word(RANGE_FIRSTS + range)] = visible;
    }
    for (uint k = 0u; k < CROWD_RANGES; ++k) {
        uint end = k + 1u < CROWD_RANGES ? bin_words[head_word(RANGE_FIRSTS + k + 1u)] : visible;
        uint count = end - bin_words[head_word(RANGE_FIRSTS + k)];
        uint head = head_word(RANGES + 4u * k);
        uint groups = (count + 63u) / 64u;
        bin_words[head] = min(groups, GROUPS_ACROSS);
        bin_words[head + 1u] = (groups + GROUPS_ACROSS - 1u) / GROUPS_ACROSS;
        bin_words[head + 2u] = 1u;
        bin_words[head + 3u] = count;
    }
    for (uint layer = 0u; layer < crowd.size.z; ++layer) {
        uint command = layer_word(layer, LAYER_COMMAND);
        bool of_pixels = crowd.tiles.w != 0u;
        bin_words[command + 1u] = of_pixels ? crowd.steps.y : 1u;
        bin_words[command + 2u] = of_pixels ? 1u : 6u * (crowd.tiles.x / 4u + layer * tile_count());
    }
}

// Puts the numbers of copies in the order of steps.
void order(uint visible)
{
    uint step = step_of(bin_words[crowd.copies.x + VISIBLE_WORDS * visible + 1u]);
    bin_words[crowd.copies.y + atomicAdd(bin_words[head_word(STEPS + step)], 1u)] = visible;
}

// Finds the first place of each tile's queue: one work group adds up whole blocks.
void place_tiles()
{
    uint self = gl_LocalInvocationIndex;
    uint lists = tile_count() * crowd.size.z;
    uint each = (lists + 63u) / 64u;
    uint first = min(self * each, lists);
    uint end = min(first + each, lists);
    uint sum = 0u;
    for (uint k = first; k < end; ++k) {
        sum += (bin_words[crowd.lists.x + k] + QUEUE_BLOCK - 1u) / QUEUE_BLOCK;
    }
    sums[self] = sum;
    barrier();
    sum = 0u;
    for (uint k = 0u; k < self; ++k) {
        sum += sums[k];
    }
    for (uint k = first; k < end; ++k) {
        bin_words[crowd.lists.w + k] = sum * QUEUE_BLOCK;
        sum += (bin_words[crowd.lists.x + k] + QUEUE_BLOCK - 1u) / QUEUE_BLOCK;
    }
}

// Takes `count` records of a layer, adds what draws them to its command, and returns the first one.
uint take_records(uint layer, uint count)
{
    uint first = atomicAdd(bin_words[layer_word(layer, LAYER_RECORDS)], count);
    uint command = layer_word(layer, LAYER_COMMAND);
    if (crowd.tiles.w == 0u) {
        atomicAdd(bin_words[command], 6u * count);
        return first;
    }
    uint column = 64u * crowd.steps.y; // pixels of a column of groups
    atomicAdd(bin_words[command], (first + count + column - 1u) / column - (first + column - 1u) / column);
    return first;
}

// Writes the records of a tile of a layer: of four words for fragments, of three for each pixel that shows a copy in
// compute. Clears the marks of its queue. If there were too many entries, the queue holds all listed copies.
void record(uint list)
{
    uint count = bin_words[crowd.lists.x + list];
    uint first = crowd.tiles.z + QUEUE_WORDS * bin_words[crowd.lists.w + list];
    uint layer = list / tile_count();
    bool all = overflows();
    if (count == 0u && !all) {
        return;
    }
    uint tile = list - layer * tile_count();
    uint near = ~bin_words[crowd.lists.y + list];
    uvec2 bits = uvec2(bin_words[crowd.lists.z + 2u * list], bin_words[crowd.lists.z + 2u * list + 1u]);
    if (all) {
        first = crowd.tiles.y;
        count = count_of(LISTED) | layer << QUEUE_LAYER_SHIFT | QUEUE_ALL;
        near = 0u;
        bits = uvec2(0xffffffffu);
    } else {
        for (uint block = first; block < first + QUEUE_WORDS * count; block += QUEUE_WORDS * QUEUE_BLOCK) {
            for (uint k = 0u; k < 2u * QUEUE_BLOCK; ++k) {
                tile_words[block + 2u * QUEUE_BLOCK + k] = 0u;
            }
        }
    }
    count |= QUEUE_LOOSE;
    uvec2 place = uvec2(tile % crowd.size.x, tile / crowd.size.x);
    if (crowd.tiles.w == 0u) {
        uint at = crowd.tiles.x + 4u * (layer * tile_count() + take_records(layer, 1u));
        uint both = bits.x | bits.y;
        uvec4 halves = uvec4(notEqual(uvec4(both & 0x0f0f0f0fu, both & 0xf0f0f0f0u, bits), uvec4(0u)));
        uint shown = halves.x | halves.y << 1 | halves.z << 2 | halves.w << 3;
        tile_words[at] = place.x | place.y << TILE_BITS | shown << RECORD_HALVES_SHIFT;
        tile_words[at + 1u] = first;
        tile_words[at + 2u] = count;
        tile_words[at + 3u] = near;
        return;
    }
    uint number = take_records(layer, uint(bitCount(bits.x) + bitCount(bits.y)));
    uint at = crowd.tiles.x + 3u * (layer * 64u * tile_count() + number);
    uint corner = GROUP_PIXELS * (place.x | place.y << 16);
    for (uint k = 0u; k < 64u; ++k) {
        if (((k < 32u ? bits.x : bits.y) >> (k & 31u) & 1u) != 0u) {
            tile_words[at] = corner + (k & 7u | k >> 3 << 16);
            tile_words[at + 1u] = first;
            tile_words[at + 2u] = count;
            at += 3u;
        }
    }
}

// Puts an entry into the queue of its tile, and marks its pixels. Entries of a tile are in the order of ranges.
void queue(uint entry)
{
    uint at = crowd.copies.w + ENTRY_WORDS * entry;
    uint place = bin_words[crowd.lists.w + bin_words[at]] + bin_words[at + 5u];
    uint word = queue_word(crowd.tiles.z, place);
    tile_words[word] = bin_words[at + 1u];
    tile_words[word + 1u] = bin_words[at + 2u];
    uint slot = place % QUEUE_BLOCK;
    uint marks = word + 2u * (QUEUE_BLOCK - slot);
    for (uint k = 0u; k < 2u; ++k) {
        // Two pixels share a word.
        uint bits = bin_words[at + 3u + k];
        while (bits != 0u) {
            uint pair = uint(findLSB(bits)) / 2u;
            uint both = bits >> 2u * pair & 3u;
            atomicOr(tile_words[marks + 16u * k + pair], (both & 1u | (both & 2u) << 15) << slot);
            bits &= ~(3u << 2u * pair);
        }
    }
}

void main()
{
    uint n = invocation();
    if (pushed.bin == ORDER_RANGES && n == 0u) {
        make_ranges();
    } else if (pushed.bin == ORDER_COPIES && n < count_of(VISIBLE)) {
        order(n);
    } else if (pushed.bin == ORDER_TILES) {
        place_tiles();
    } else if (pushed.bin == ORDER_RECORDS && n < tile_count() * crowd.size.z) {
        record(n);
    } else if (pushed.bin == ORDER_ENTRIES && !overflows() && n < count_of(ENTRIES)) {
        queue(n);
    }
}
