/*
 * Uses every structure that begins with its size. Compiled with headers of earlier releases, it must print what it
 * prints with the present one.
 */
#include <revmap.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RM(call)                                                                  \
    do {                                                                          \
        if ((call) != REVMAP_RESULT_OK) {                                         \
            fprintf(stderr, "%s: %s\n", #call, revmap_last_error_text());         \
            exit(1);                                                              \
        }                                                                         \
    } while (0)

/* A structure, and bytes behind it that no function may touch. */
#define DECLARE(Type, name)                                \
    struct {                                               \
        Type value;                                        \
        unsigned char behind[64];                          \
    } name;                                                \
    memset(&name, 0x5a, sizeof name);                      \
    name.value.size = sizeof name.value
#define CHECK(name)                                                                             \
    for (size_t n = 0; n < sizeof name.behind; ++n) {                                           \
        if (name.behind[n] != 0x5a || name.value.size != sizeof name.value) {                   \
            fprintf(stderr, "%s is overwritten\n", #name);                                      \
            exit(1);                                                                            \
        }                                                                                       \
    }
#define FILLED(Type, name, call) \
    DECLARE(Type, name);         \
    RM(call);                    \
    CHECK(name)

int main(void)
{
    static const double points[][2] = {{0.0, 0.0}, {0.4, 0.5}, {0.0, 1.0}};
    RevmapDevice *device;
    RevmapProfile *profile;
    RM(revmap_device_open(NULL, 0, &device));
    RM(revmap_profile_from_points(points, 3, 0.5, &profile));
    FILLED(RevmapDeviceInfo, about, revmap_device_info(device, &about.value));
    FILLED(RevmapMemoryUse, memory, revmap_device_memory_use(device, &memory.value));
    FILLED(RevmapObjectInfo, object, revmap_object_defaults(&object.value));
    FILLED(RevmapLighting, lighting, revmap_lighting_defaults(&lighting.value));
    FILLED(RevmapCamera, camera, revmap_camera_defaults(&camera.value));
    FILLED(RevmapSearch, search, revmap_search_defaults(&search.value));
    FILLED(RevmapPicture, picture, revmap_picture_defaults(&picture.value));
    FILLED(RevmapScene, scene, revmap_scene_defaults(&scene.value));
    if (scene.value.lighting.size != sizeof(RevmapLighting) || picture.value.search.size != sizeof(RevmapSearch)) {
        fprintf(stderr, "structures within others have other sizes\n");
        return 1;
    }

    RevmapObjectInfo objects[2] = {object.value, object.value};
    objects[0].profile = objects[1].profile = profile;
    objects[1].placement.position[1] = 0.6;
    objects[1].has_material = 1;
    scene.value.objects = objects;
    scene.value.object_count = 2;
    scene.value.lighting.shadow = REVMAP_SHADOW_HARD;
    scene.value.camera = camera.value;
    scene.value.camera.fov_y = 50.0;
    picture.value.width = 64;
    picture.value.height = 48;
    picture.value.search.tolerance = 0.5;
    RevmapOffscreen *offscreen;
    RM(revmap_offscreen_create(device, &picture.value, &scene.value, &offscreen));
    FILLED(RevmapTimes, times, revmap_offscreen_draw(offscreen, &times.value));
    static unsigned char pixels[64 * 48 * 4];
    RM(revmap_offscreen_read(offscreen, REVMAP_PLANE_SRGB8, pixels, sizeof pixels));
    uint64_t hash = 0xcbf29ce484222325u;
    unsigned hits = 0;
    for (size_t n = 0; n < sizeof pixels; ++n) {
        hash = (hash ^ pixels[n]) * 0x100000001b3u;
        hits += n % 4 == 3 && pixels[n] == 255;
    }

    const VkFormat color = VK_FORMAT_R8G8B8A8_SRGB;
    const RevmapPass pass = {
        .size = sizeof pass,
        .samples = 1,
        .color_formats = &color,
        .color_format_count = 1,
        .depth_format = VK_FORMAT_D32_SFLOAT,
    };
    const RevmapComputeTarget target = {.size = sizeof target};
    const RevmapView view = {.size = sizeof view};
    RevmapRenderer *renderer;
    RevmapObject added;
    RM(revmap_renderer_create(device, &pass, &search.value, 1, &renderer));
    RM(revmap_renderer_set_lighting(renderer, &lighting.value));
    RM(revmap_renderer_add(renderer, &objects[1], &added));
    FILLED(RevmapStatistics, work, revmap_renderer_statistics(renderer, &work.value));
    /* Structures of the right size with values that are not. */
    const int refused = revmap_renderer_set_compute_target(renderer, &target) == REVMAP_RESULT_USAGE
        && strstr(revmap_last_error_text(), "bytes") == NULL
        && revmap_renderer_prepare(renderer, NULL, 0, &view) == REVMAP_RESULT_CONTENT;
    printf("hits %u, picture %016llx, objects %u, refused %d\n", hits, (unsigned long long)hash, work.value.objects,
           refused);
    RM(revmap_renderer_destroy(renderer));
    RM(revmap_offscreen_destroy(offscreen));
    RM(revmap_profile_destroy(profile));
    RM(revmap_device_destroy(device));
    return hits > 100 && refused ? 0 : 1;
}
