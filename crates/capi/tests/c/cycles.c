/*
 * Makes and destroys everything many times on one device of its own, and fails if the heap grows.
 *
 *     cycles DRAWING.svg
 */
#include <malloc.h>
#include <revmap.h>
#include <stdio.h>
#include <stdlib.h>

#include "host.h"

enum { WARM = 300, CYCLES = 2000 };

static void check_revmap(RevmapResult result, const char *call)
{
    if (result != REVMAP_RESULT_OK) {
        fail(call, revmap_last_error_text());
    }
}
#define RM(call) check_revmap((call), #call)

static void cycle(const RevmapHostDevice *lent, const RevmapPass *pass, const char *drawing)
{
    static const double points[][2] = {{0.0, 0.0}, {0.4, 0.5}, {0.0, 1.0}};
    static const unsigned char texels[4][4] = {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {9, 9, 9, 255}};
    static const float heights[4] = {0.0f, 0.5f, 1.0f, 0.5f};
    RevmapDevice *device;
    RevmapProfile *spindle, *drawn;
    RevmapColorMap *colors;
    RevmapHeightMap *bumps;
    RevmapRenderer *renderer, *compute;
    RevmapPrewarm *prewarm;
    RevmapRayCaster *rays;
    RevmapObject object, computed;
    RM(revmap_device_borrow(lent, &device));
    RM(revmap_profile_from_points(points, 3, 0.5, &spindle));
    RM(revmap_profile_from_file(drawing, REVMAP_AXIS_CENTER, &drawn));
    RM(revmap_color_map_from_texels(2, 2, texels, &colors));
    RM(revmap_height_map_from_heights(2, 2, heights, REVMAP_SLOPE_FILTER_SCHARR, &bumps));
    RM(revmap_renderer_create(device, pass, NULL, FRAMES_IN_FLIGHT, &renderer));
    RM(revmap_renderer_create_compute(device, REVMAP_PLANES_COLOR, NULL, FRAMES_IN_FLIGHT, &compute));
    RevmapObjectInfo info = {.size = sizeof info};
    RM(revmap_object_defaults(&info));
    info.profile = spindle;
    info.color_map = colors;
    info.height_map = bumps;
    RM(revmap_renderer_add(renderer, &info, &object));
    RM(revmap_renderer_add(compute, &info, &computed));
    RM(revmap_renderer_prewarm(renderer, &prewarm));
    RM(revmap_renderer_ray_caster(renderer, object, &rays));
    /* What fails must not keep anything either. */
    if (revmap_profile_from_points(points, 2, 0.5, &spindle) != REVMAP_RESULT_CONTENT) {
        fail("cycle", "two points made a profile");
    }
    RM(revmap_ray_caster_destroy(rays));
    RM(revmap_prewarm_destroy(prewarm));
    RM(revmap_renderer_destroy(compute));
    RM(revmap_renderer_destroy(renderer));
    RM(revmap_height_map_destroy(bumps));
    RM(revmap_color_map_destroy(colors));
    RM(revmap_profile_destroy(drawn));
    RM(revmap_profile_destroy(spindle));
    RM(revmap_device_destroy(device));
}

static size_t heap(void)
{
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

int main(int count, char **arguments)
{
    if (count != 2) {
        fail("cycles", "give a drawing");
    }
    Host host = {0};
    host_open_instance(&host);
    uint32_t one = 1;
    vkEnumeratePhysicalDevices(host.instance, &one, &host.physical);
    RevmapRequirements needs = {.size = sizeof needs};
    RM(revmap_requirements(vkGetInstanceProcAddr, host.instance, host.physical, &needs));
    host.family = needs.queue_family;
    host_open_device(&host, &needs.features);
    const RevmapHostDevice lent = {
        .size = sizeof lent,
        .queue_family = host.family,
        .get_instance_proc_addr = vkGetInstanceProcAddr,
        .instance = host.instance,
        .physical_device = host.physical,
        .device = host.device,
        .features = &needs.features,
    };
    const VkFormat color = COLOR_FORMAT;
    const RevmapPass pass = {
        .size = sizeof pass,
        .samples = 1,
        .color_formats = &color,
        .color_format_count = 1,
        .depth_format = DEPTH_FORMAT,
    };
    for (int n = 0; n < WARM; ++n) {
        cycle(&lent, &pass, arguments[1]);
    }
    const size_t before = heap();
    for (int n = 0; n < CYCLES; ++n) {
        cycle(&lent, &pass, arguments[1]);
    }
    const size_t after = heap();
    host_close(&host);
    printf("heap after %d cycles: %zu bytes, after %d more: %zu\n", WARM, before, CYCLES, after);
    /*
     * The smallest block of the heap takes 32 bytes: one left in every cycle would be 64,000. What threads keep for
     * themselves moves by up to 28,000 however many cycles there are.
     */
    if (after > before && after - before > (size_t)24 * CYCLES) {
        fail("cycles", "the heap grows");
    }
    return EXIT_SUCCESS;
}
