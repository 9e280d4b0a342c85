// Result of a search.
#ifndef HIT_GLSL
#define HIT_GLSL

struct Hit {
    float t; // from the ray's origin, not from the eye
    vec3 normal; // object space, outward, of any length
    vec3 point;  // object units, relative to the axis of the replica that was hit
    vec3 sense;  // -1 where that replica is reflected
    uint steps;  // number of look-ups of the search
    bool exhausted; // the search ran out of steps
    bool at_border; // the ray came from within and hit the face of box or cell, not the surface
};

const Hit NO_HIT = Hit(0.0, vec3(0.0), vec3(0.0), vec3(1.0), 0u, false, false);

#endif
