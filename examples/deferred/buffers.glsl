// What both compute passes read and write.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D base_color;
layout(set = 0, binding = 1) uniform sampler2D octahedral;
layout(set = 0, binding = 2) uniform sampler2D material;
layout(set = 0, binding = 3) uniform sampler2D motion; // pixels, from now to the last frame
layout(set = 0, binding = 4) uniform usampler2D identity;
layout(set = 0, binding = 5) uniform sampler2D depth;
layout(set = 0, binding = 6, rgba32f) uniform image2D lit;
layout(set = 0, binding = 7, rgba32f) uniform readonly image2D last_picture;
layout(set = 0, binding = 8, rgba32f) uniform writeonly image2D picture;
layout(push_constant) uniform Pushed {
    mat4 matrix;
    vec4 first;
    vec4 second;
} pushed;
