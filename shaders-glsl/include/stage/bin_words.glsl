// The words that say which pixels are visited and what may show there. First come records of four words, then lists.
//
// In compute a bin is a square of GROUP_PIXELS^2: its corner in pixels (x | y << 16), the word where its list begins, how
// many copies the list holds, the bits of the nearest depth. A list has two words a copy, nearest first: the instance's
// number, the bits of the nearest depth of the copy. Where BIN_SPLIT stands in place of the number, it is no square: it
// holds as many pixels from anywhere, so that no invocation is spent on pixels that show nothing. Each has three words:
// its place (x | y << 16), where its list begins, from the first of these words on, how many copies it holds. Places
// behind the last pixel are 0xffffffff, outside of every picture; corner and depth of such a bin are 0.
//
// Fragments are drawn for squares of 1, 2, 4 or 8 pixels a side: the corner in pixels and the side's logarithm
// (x | y << SQUARE_BITS | logarithm << 2 SQUARE_BITS). Those of one copy, spots, hold the instance's number; 0; the bits
// of its nearest depth. Those of several hold what a bin does. Split, BIN_SPLIT | side stands in place of the number of
// copies, and each pixel has a list: two words for each, row by row, where it begins, from the first of these words on,
// and how many copies it holds.
//
// Of batches that take beams: the three words of an indirect dispatch, one unused, and four words a tile: its corner,
// the bits of its first and last t, one unused; or what patch_lists.glsl says.
#ifndef BIN_WORDS_GLSL
#define BIN_WORDS_GLSL
#ifndef BIN_WORDS
#define BIN_WORDS readonly
#endif

layout(set = 2, binding = 1, std430) BIN_WORDS buffer BinWords {
    uint bin_words[];
};

#endif
