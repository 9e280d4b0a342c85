// The words that say which pixels are visited and what may show there. First come records of four words, then lists.
//
// A bin is a square of GROUP_PIXELS^2: its corner in pixels (x | y << 16), the word where its list begins, how many
// copies the list holds, the bits of the nearest depth. A list has two words a copy, nearest first: the instance's
// number, the bits of the nearest depth of the copy. Where BIN_SPLIT stands in place of the number, each pixel has a
// list: the first words are two for each, where it begins, from the first of these words on, and how many copies it
// holds. In compute a split bin is no square: it holds as many pixels from anywhere, so that no invocation is spent on
// pixels that show nothing. Each has three words: its place (x | y << 16), where its list begins, how many copies it
// holds. Places behind the last pixel are 0xffffffff, outside of every picture; corner and depth of such a bin are 0.
//
// A run is a rectangle that fragments are drawn for, a bin high and some bins wide at most: its corner in pixels, the
// number of its first bin, its other corner (exclusive), the bits of the nearest depth.
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
