/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "options.h"

#include <cstdlib>
#include <glib.h>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace dff {

namespace {

struct Rest {
    void operator()(GOptionContext *context) const { g_option_context_free(context); }
};

/* What GOption fills in, before it is checked. */
struct Values {
    gchar *scene = nullptr;
    gchar *image = nullptr;
    gchar *depth_map = nullptr;
    gchar *board = nullptr;
    gchar *pose = nullptr;
    gchar *calibration = nullptr;
    gdouble breathing = 0.0;
    gdouble field_curvature = 0.0;
    gdouble vignetting = 0.0;
    gchar *noise = nullptr;
    gchar *size = nullptr;
    gint planes = 6;
    gdouble rate = 26.0;
    gdouble near = 5.0;
    gdouble far = 0.0;
    gint64 seed = 0;
    gint64 sweeps = 0;
    gchar *pause = nullptr;
    gchar *lens = nullptr;
    gdouble settle_ms = 2.0;
    gchar *lose = nullptr;
    gchar *ignore = nullptr;
    gchar *duplicate = nullptr;
    gchar *reorder = nullptr;
    gchar *delay = nullptr;
    gdouble delay_ms = 20.0;
    gchar *lose_sync = nullptr;
    gint64 clock_offset_ns = 0;
    gdouble clock_drift_ppm = 0.0;
    gint first_id = 65400;
    gboolean restart_ids = FALSE;
    gdouble readout_ms = 1.0;
    gboolean stamp = FALSE;
    gchar *serial = nullptr;
    gchar *interface = nullptr;
    gchar *genicam = nullptr;
    gchar *run_line = nullptr;
    gchar *sync_line = nullptr;
    gchar *truth = nullptr;
};

void parse_arguments(Values &v, int argc, char **argv)
{
    const GOptionEntry entries[] = {
        {"scene", 0, 0, G_OPTION_ARG_STRING, &v.scene, "What stands before the camera [shapes]",
         "shapes|slant|files|board"},
        {"image", 0, 0, G_OPTION_ARG_FILENAME, &v.image, "Sharp picture of --scene=files", "FILE"},
        {"depth-map", 0, 0, G_OPTION_ARG_FILENAME, &v.depth_map, "Disparity map of --scene=files", "FILE"},
        {"board", 0, 0, G_OPTION_ARG_STRING, &v.board, "Squares and millimetres of --scene=board [10x7x25]",
         "CxRxMM"},
        {"pose", 0, 0, G_OPTION_ARG_STRING, &v.pose, "Where that board is, metres and degrees [0,0,0.5]",
         "X,Y,Z,RX,RY,RZ"},
        {"calibration", 0, 0, G_OPTION_ARG_FILENAME, &v.calibration, "Camera that sees that board", "FILE"},
        {"breathing", 0, 0, G_OPTION_ARG_DOUBLE, &v.breathing,
         "Magnification of the last plane less that of the first [0]", "SHARE"},
        {"field-curvature", 0, 0, G_OPTION_ARG_DOUBLE, &v.field_curvature,
         "Planes that the corners' focus lies farther away [0]", "PLANES"},
        {"vignetting", 0, 0, G_OPTION_ARG_DOUBLE, &v.vignetting, "Light that the corners lose [0]", "SHARE"},
        {"noise", 0, 0, G_OPTION_ARG_STRING, &v.noise, "Of the sensor [none]",
         "none|mild|moderate|strong|GAIN,READ"},
        {"seed", 0, 0, G_OPTION_ARG_INT64, &v.seed, "Of the scene, the noise and the faults [0]", "N"},
        {"size", 0, 0, G_OPTION_ARG_STRING, &v.size, "Of the sensor, pixels [640x480]", "WxH"},
        {"planes", 0, 0, G_OPTION_ARG_INT, &v.planes, "Planes a sweep [6]", "N"},
        {"rate", 0, 0, G_OPTION_ARG_DOUBLE, &v.rate, "Sweeps a second [26]", "HZ"},
        {"near", 0, 0, G_OPTION_ARG_DOUBLE, &v.near, "Vergence of plane 0 [5]", "DIOPTRES"},
        {"far", 0, 0, G_OPTION_ARG_DOUBLE, &v.far, "Vergence of the last plane [0]", "DIOPTRES"},
        {"sweeps", 0, 0, G_OPTION_ARG_INT64, &v.sweeps, "The sequencer stops after so many; 0: never [0]",
         "N"},
        {"pause", 0, 0, G_OPTION_ARG_STRING, &v.pause, "The sequencer pauses, AT:FOR seconds", "AT:FOR"},
        {"lens", 0, 0, G_OPTION_ARG_STRING, &v.lens, "Who moves the lens [sequencer]", "sequencer|register"},
        {"settle", 0, 0, G_OPTION_ARG_DOUBLE, &v.settle_ms, "--lens=register moves for so long [2]", "MS"},
        {"lose", 0, 0, G_OPTION_ARG_STRING, &v.lose, "Frames that are exposed and never sent", "N|~N"},
        {"ignore", 0, 0, G_OPTION_ARG_STRING, &v.ignore, "Triggers that give no frame and no frame id",
         "N|~N"},
        {"duplicate", 0, 0, G_OPTION_ARG_STRING, &v.duplicate, "Frames that are sent twice", "N|~N"},
        {"reorder", 0, 0, G_OPTION_ARG_STRING, &v.reorder, "Frames that are sent after the next", "N|~N"},
        {"delay", 0, 0, G_OPTION_ARG_STRING, &v.delay, "Frames that are sent late", "N|~N"},
        {"delay-time", 0, 0, G_OPTION_ARG_DOUBLE, &v.delay_ms, "How late [20]", "MS"},
        {"lose-sync", 0, 0, G_OPTION_ARG_STRING, &v.lose_sync, "Sync edges that do not arrive", "N|~N"},
        {"clock-offset", 0, 0, G_OPTION_ARG_INT64, &v.clock_offset_ns, "Of the camera's clock [0]", "NS"},
        {"clock-drift", 0, 0, G_OPTION_ARG_DOUBLE, &v.clock_drift_ppm, "Of the camera's clock [0]", "PPM"},
        {"first-id", 0, 0, G_OPTION_ARG_INT, &v.first_id, "Frame id of the first frame, 1 to 65535 [65400]",
         "N"},
        {"restart-ids", 0, 0, G_OPTION_ARG_NONE, &v.restart_ids, "Each acquisition begins with frame id 1",
         nullptr},
        {"readout", 0, 0, G_OPTION_ARG_DOUBLE, &v.readout_ms, "Time to read a frame out [1]", "MS"},
        {"stamp", 0, 0, G_OPTION_ARG_NONE, &v.stamp, "Write sweep and plane into the first 64 pixels",
         nullptr},
        {"serial", 0, 0, G_OPTION_ARG_STRING, &v.serial, "Serial number [BENCH]", "TEXT"},
        {"interface", 0, 0, G_OPTION_ARG_STRING, &v.interface, "Name or address of the network [lo]", "NAME"},
        {"genicam", 0, 0, G_OPTION_ARG_FILENAME, &v.genicam, "Another description of the camera", "FILE"},
        {"run-line", 0, 0, G_OPTION_ARG_FILENAME, &v.run_line, "Socket of the run line; none: always high",
         "PATH"},
        {"sync-line", 0, 0, G_OPTION_ARG_FILENAME, &v.sync_line, "Socket of the sync line; none: not wired",
         "PATH"},
        {"truth", 0, 0, G_OPTION_ARG_FILENAME, &v.truth, "16-bit PNG of the true depth to write", "FILE"},
        {nullptr, 0, 0, G_OPTION_ARG_NONE, nullptr, nullptr, nullptr},
    };
    const std::unique_ptr<GOptionContext, Rest> context(
        g_option_context_new("- a GigE Vision camera before a simulated swept lens"));
    g_option_context_set_description(
        context.get(),
        "N is every N-th, ~N is one in N by chance. Prints \"ready\" once it can be used, and on SIGTERM\n"
        "or SIGINT a JSON object of what it did.");
    g_option_context_add_main_entries(context.get(), entries, nullptr);
    g_autoptr(GError) error = nullptr;
    if (!g_option_context_parse(context.get(), &argc, &argv, &error))
        throw std::invalid_argument(error->message);
    if (argc > 1)
        throw std::invalid_argument(std::string("what is \"") + argv[1] + "\"?");
}

std::string text(gchar *value, const std::string &otherwise = {})
{
    const std::unique_ptr<gchar, decltype(&g_free)> owned(value, g_free);
    return value ? value : otherwise;
}

Frequency frequency(gchar *value)
{
    const std::string given = text(value);
    return given.empty() ? Frequency{} : Frequency::parse(given);
}

/* "A<separator>B" */
template <typename Number> std::pair<Number, Number> two_numbers(const std::string &given, char separator)
{
    std::istringstream stream(given);
    Number first{};
    Number second{};
    char between = 0;
    if (!(stream >> first >> between >> second) || between != separator || !stream.eof())
        throw std::invalid_argument("\"" + given + "\" should be two numbers with '" + separator +
                                    "' between them");
    return {first, second};
}

uint64_t nanoseconds(double milliseconds)
{
    if (milliseconds < 0.0)
        throw std::invalid_argument("a time is negative");
    return static_cast<uint64_t>(milliseconds * 1e6);
}

GstLensSweepTestScene scene_kind(const std::string &name)
{
    if (name == "shapes")
        return GST_LENS_SWEEP_TEST_SCENE_SHAPES;
    if (name == "slant")
        return GST_LENS_SWEEP_TEST_SCENE_SLANT;
    if (name == "files")
        return GST_LENS_SWEEP_TEST_SCENE_FILES;
    if (name == "board")
        return GST_LENS_SWEEP_TEST_SCENE_BOARD;
    throw std::invalid_argument("the scene \"" + name + "\" is not known; use shapes, slant, files or board");
}

bool is_register_lens(const std::string &name)
{
    if (name != "sequencer" && name != "register")
        throw std::invalid_argument("the lens \"" + name + "\" is not known; use sequencer or register");
    return name == "register";
}

TestScene scene_of(const Values &v)
{
    TestScene scene;
    scene.scene = scene_kind(text(v.scene, "shapes"));
    scene.image = text(v.image);
    scene.depth_map = text(v.depth_map);
    scene.board = text(v.board, scene.board);
    scene.pose = text(v.pose, scene.pose);
    scene.calibration = text(v.calibration);
    scene.breathing = v.breathing;
    scene.field_curvature = v.field_curvature;
    scene.vignetting = v.vignetting;
    scene.noise = text(v.noise, "none");
    scene.seed = static_cast<guint64>(v.seed);
    scene.check();
    return scene;
}

SequencerSettings sequencer_of(const Values &v)
{
    SequencerSettings settings;
    settings.planes = static_cast<unsigned>(v.planes);
    settings.rate = v.rate;
    if (v.rate <= 0.0)
        throw std::invalid_argument("the rate must be above 0");
    if (v.sweeps > 0)
        settings.sweeps = static_cast<uint64_t>(v.sweeps);
    const std::string pause = text(v.pause);
    if (!pause.empty())
        std::tie(settings.pause_at, settings.pause_for) = two_numbers<double>(pause, ':');
    return settings;
}

FaultSettings faults_of(const Values &v)
{
    return {frequency(v.ignore), frequency(v.lose),       frequency(v.duplicate),       frequency(v.reorder),
            frequency(v.delay),  nanoseconds(v.delay_ms), static_cast<uint64_t>(v.seed)};
}

BenchCameraSettings camera_of(const Values &v)
{
    if (v.first_id < 1 || v.first_id > UINT16_MAX)
        throw std::invalid_argument("the first frame id must be 1 to 65535");
    BenchCameraSettings settings;
    settings.plan = SweepPlan::even(static_cast<unsigned>(v.planes), v.near, v.far);
    settings.interface = text(v.interface, settings.interface);
    settings.serial = text(v.serial, settings.serial);
    settings.genicam = text(v.genicam, BENCH_CAMERA_GENICAM);
    settings.register_lens = is_register_lens(text(v.lens, "sequencer"));
    settings.settle_ns = nanoseconds(v.settle_ms);
    settings.stamp = v.stamp != FALSE;
    settings.clock = {v.clock_offset_ns, v.clock_drift_ppm};
    settings.sensor = {static_cast<uint16_t>(v.first_id), v.restart_ids != FALSE, nanoseconds(v.readout_ms)};
    settings.faults = faults_of(v);
    return settings;
}

} // namespace

Options parse_options(int argc, char **argv)
{
    Values v;
    parse_arguments(v, argc, argv);
    Options options;
    options.scene = scene_of(v);
    options.sequencer = sequencer_of(v);
    options.camera = camera_of(v);
    options.lose_sync = frequency(v.lose_sync);
    options.run_line = text(v.run_line);
    options.sync_line = text(v.sync_line);
    options.truth = text(v.truth);
    const std::string size = text(v.size);
    if (!size.empty())
        std::tie(options.size.width, options.size.height) = two_numbers<int>(size, 'x');
    if (options.size.width < 64 || options.size.height < 16)
        throw std::invalid_argument("the sensor must be 64x16 pixels at least");
    return options;
}

} // namespace dff
