/*
 * An engine in C99 that draws revolved solids next to its own triangle: its device, its images, its depth buffer, two frames in
 * flight.
 *
 *     engine OUT.ppm          the last of eight frames
 *     engine OUT.ppm alone    the same without the triangle
 */
#include <revmap.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host.h"

enum { FRAMES = 8 };

static void check_revmap(RevmapResult result, const char *call)
{
    if (result != REVMAP_RESULT_OK) {
        fail(call, revmap_last_error_text());
    }
}
#define RM(call) check_revmap((call), #call)

/* From (2.976, 0, 1.368) towards (0, 0, 0.5). Columns. */
static const double VIEW[16] = {
    0.0, -0.28, 0.96, 0.0,   1.0, 0.0, 0.0, 0.0,   0.0, 0.96, 0.28, 0.0,   0.0, -0.48, -3.24, 1.0,
};
/* Depth is reversed: 1 at a distance of 0.1, 0 at infinity. */
static const double PROJECTION[16] = {
    2.0625, 0.0, 0.0, 0.0,   0.0, -2.75, 0.0, 0.0,   0.0, 0.0, 0.0, -1.0,   0.0, 0.0, 0.1, 0.0,
};

static void multiply(const double a[16], const double b[16], float product[16])
{
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            double sum = 0.0;
            for (int k = 0; k < 4; ++k) {
                sum += a[4 * k + row] * b[4 * column + k];
            }
            product[4 * column + row] = (float)sum;
        }
    }
}

/* The first device on which everything works. */
static RevmapRequirements choose_device(Host *host)
{
    VkPhysicalDevice all[16];
    uint32_t count = 16;
    vkEnumeratePhysicalDevices(host->instance, &count, all);
    for (uint32_t n = 0; n < count; ++n) {
        RevmapRequirements needs = {.size = sizeof needs};
        if (revmap_requirements(vkGetInstanceProcAddr, host->instance, all[n], &needs) == REVMAP_RESULT_OK) {
            host->physical = all[n];
            host->family = needs.queue_family;
            return needs;
        }
    }
    fail("choose_device", count == 0 ? "no Vulkan device" : revmap_last_error_text());
    exit(EXIT_FAILURE);
}

static RevmapRenderer *make_renderer(const Host *host, const RevmapRequirements *needs)
{
    const RevmapHostDevice lent = {
        .size = sizeof lent,
        .queue_family = host->family,
        .get_instance_proc_addr = vkGetInstanceProcAddr,
        .instance = host->instance,
        .physical_device = host->physical,
        .device = host->device,
        .features = &needs->features,
    };
    RevmapDevice *device;
    RM(revmap_device_borrow(&lent, &device));
    const VkFormat color = COLOR_FORMAT;
    const RevmapPass pass = {
        .size = sizeof pass,
        .kind = REVMAP_PASS_KIND_DYNAMIC,
        .samples = 1,
        .depth_order = REVMAP_DEPTH_ORDER_REVERSED,
        .planes = REVMAP_PLANES_COLOR,
        .color_formats = &color,
        .color_format_count = 1,
        .depth_format = DEPTH_FORMAT,
    };
    RevmapRenderer *renderer;
    RM(revmap_renderer_create(device, &pass, NULL, FRAMES_IN_FLIGHT, &renderer));
    /* The renderer keeps what it needs of the device. */
    RM(revmap_device_destroy(device));
    return renderer;
}

static RevmapObject add_goblet(RevmapRenderer *renderer)
{
    const double points[][2] = {
        {0.0, 0.0}, {0.3, 0.0}, {0.06, 0.12}, {0.06, 0.45}, {0.35, 0.7}, {0.3, 1.0}, {0.0, 0.6},
    };
    RevmapProfile *profile;
    RM(revmap_profile_from_points(points, 7, 0.4, &profile));
    RevmapObjectInfo info = {.size = sizeof info};
    RM(revmap_object_defaults(&info));
    info.profile = profile;
    info.color[0] = 0.75f;
    info.color[1] = 0.55f;
    info.color[2] = 0.3f;
    RevmapObject goblet;
    RM(revmap_renderer_add(renderer, &info, &goblet));
    RM(revmap_profile_destroy(profile));
    return goblet;
}

static void add_spindles(RevmapRenderer *renderer)
{
    const double points[][2] = {{0.0, 0.0}, {0.35, 0.2}, {0.1, 0.5}, {0.35, 0.8}, {0.0, 1.0}};
    RevmapProfile *profile;
    RM(revmap_profile_from_points(points, 5, 0.4, &profile));
    RevmapPlacement placements[5];
    for (int n = 0; n < 5; ++n) {
        const RevmapPlacement placement = {
            .position = {-0.75, 0.5 * n - 1.0, 0.25 * (n % 2)},
            .rotation = {0.0, 0.0, 0.0, 1.0},
            .scale = {0.5, 0.5, 0.5},
        };
        placements[n] = placement;
    }
    RevmapObjectInfo info = {.size = sizeof info};
    RM(revmap_object_defaults(&info));
    info.profile = profile;
    info.color[0] = 0.25f;
    info.color[1] = 0.5f;
    info.color[2] = 0.35f;
    info.instances = placements;
    info.instance_count = 5;
    RevmapObject spindles;
    RM(revmap_renderer_add(renderer, &info, &spindles));
    RM(revmap_profile_destroy(profile));
}

/* Distance from the eye to an object in the middle of the picture; infinite if it is not there. */
static double pick(RevmapRenderer *renderer, RevmapObject object)
{
    const RevmapRay ray = {.origin = {2.976, 0.0, 1.368}, .direction = {-0.96, 0.0, -0.28}};
    RevmapRayCaster *caster;
    RevmapRayHit hit;
    RM(revmap_renderer_ray_caster(renderer, object, &caster));
    RM(revmap_ray_caster_cast(caster, &ray, 1, &hit));
    RM(revmap_ray_caster_destroy(caster));
    return hit.t;
}

int main(int count, char **arguments)
{
    if (count < 2 || revmap_abi() != REVMAP_ABI) {
        fail("engine", "give the path of a picture to write, and link the library of this header");
    }
    const bool alone = count > 2 && strcmp(arguments[2], "alone") == 0;
    Host host = {0};
    host_open_instance(&host);
    const RevmapRequirements needs = choose_device(&host);
    host_open_device(&host, &needs.features);

    RevmapRenderer *renderer = make_renderer(&host, &needs);
    const RevmapObject goblet = add_goblet(renderer);
    add_spindles(renderer);
    RevmapPrewarm *prewarm;
    RM(revmap_renderer_prewarm(renderer, &prewarm));
    RM(revmap_prewarm_compile(prewarm)); /* an engine does this in another thread */
    RM(revmap_prewarm_destroy(prewarm));

    RevmapView view = {
        .size = sizeof view,
        .depth_order = REVMAP_DEPTH_ORDER_REVERSED,
        .viewport = {0.0, 0.0, WIDTH, HEIGHT},
    };
    memcpy(view.view, VIEW, sizeof VIEW);
    memcpy(view.projection, PROJECTION, sizeof PROJECTION);
    float clip_from_world[16];
    multiply(PROJECTION, VIEW, clip_from_world);

    for (uint32_t frame = 0; frame < FRAMES; ++frame) {
        const uint32_t slot = frame % FRAMES_IN_FLIGHT;
        const RevmapOffset offset = {.extend = 0.004 * frame, .chamfer = 1.0};
        RM(revmap_renderer_set_offset(renderer, goblet, &offset));
        VkCommandBuffer commands = host_begin(&host, slot);
        RM(revmap_renderer_prepare(renderer, commands, slot, &view));
        host_begin_pass(&host, slot);
        if (!alone) {
            host_draw_triangle(&host, slot, clip_from_world);
        }
        RM(revmap_renderer_record(renderer, commands, slot));
        host_submit(&host, slot);
    }
    host_write(&host, (FRAMES - 1) % FRAMES_IN_FLIGHT, arguments[1]);
    VK(vkDeviceWaitIdle(host.device));

    RevmapStatistics statistics = {.size = sizeof statistics};
    RM(revmap_renderer_statistics(renderer, &statistics));
    printf("revmap %s: %u objects, %u by hulls, %llu surfaces made\n", revmap_version(), statistics.objects,
           statistics.drawn_by_hull, (unsigned long long)statistics.surfaces_made);
    printf("the goblet is %.3f away\n", pick(renderer, goblet));
    RM(revmap_renderer_destroy(renderer));
    host_close(&host);
    if (host.messages != 0) {
        fail("engine", "the validation layers had something to say");
    }
    return EXIT_SUCCESS;
}
