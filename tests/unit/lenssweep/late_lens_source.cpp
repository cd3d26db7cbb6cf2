/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "late_lens_source.h"

#include <array>
#include <cmath>
#include <cstring>
#include <deque>
#include <gst/base/gstpushsrc.h>
#include <mutex>
#include <random>

namespace {

constexpr int width = 96;
constexpr int height = 64;
constexpr double nearest = 10.0;

/* The lens and the way to it. Guarded by `mutex`. */
struct LateLens {
    std::mutex mutex;
    std::deque<double> on_the_way; /* one for each frame to come */
    double set = 1.0;
    double told = 1.0;
    double actual = 1.0;
    guint delay = 2;
    double lag = 0.0;
    gboolean echo = FALSE;
    bool manual = false;
    std::minstd_rand noise{1};

    /* The next frame is exposed. */
    double expose()
    {
        const std::lock_guard lock(mutex);
        on_the_way.push_back(set);
        while (on_the_way.size() > delay) {
            told = manual ? on_the_way.front() : told;
            on_the_way.pop_front();
        }
        const double left = lag > 0 ? std::exp(-1 / lag) : 0.0;
        actual = told + (actual - told) * left;
        return actual;
    }
};

void draw(guint8 *pixels, double position, std::minstd_rand &noise)
{
    std::array<int, width> texture;
    for (int x = 0; x < width; x++) {
        const double blur = std::abs(position - nearest * x / width);
        texture[x] = static_cast<int>(60 / (1 + blur * blur));
    }
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const int grain = static_cast<int>(noise() % 9) - 4;
            pixels[y * width + x] =
                static_cast<guint8>(128 + grain + ((x + y) / 2 % 2 ? texture[x] : -texture[x]));
        }
    std::memcpy(pixels, &position, sizeof position);
}

} // namespace

G_BEGIN_DECLS

struct LateLensSrc {
    GstPushSrc parent;
    LateLens *lens;
};

struct LateLensSrcClass {
    GstPushSrcClass parent_class;
};

G_END_DECLS

enum { PROP_LENS_POSITION = 1, PROP_AF_MODE, PROP_DELAY, PROP_LAG, PROP_ECHO, PROP_LIVE };
enum { MODE_AUTO, MODE_MANUAL };

static GType af_mode_get_type()
{
    static const GEnumValue values[] = {
        {MODE_AUTO, "by itself", "auto"}, {MODE_MANUAL, "by hand", "manual"}, {0, nullptr, nullptr}};
    static const GType type = g_enum_register_static("LateLensAfMode", values);
    return type;
}

GType late_lens_src_get_type();
G_DEFINE_TYPE(LateLensSrc, late_lens_src, GST_TYPE_PUSH_SRC)

static LateLens &lens_of(gpointer object)
{
    return *reinterpret_cast<LateLensSrc *>(object)->lens;
}

static void set_property(GObject *object, guint id, const GValue *value, GParamSpec *)
{
    LateLens &lens = lens_of(object);
    const std::lock_guard lock(lens.mutex);
    if (id == PROP_LENS_POSITION)
        lens.set = g_value_get_float(value);
    else if (id == PROP_AF_MODE)
        lens.manual = g_value_get_enum(value) == MODE_MANUAL;
    else if (id == PROP_DELAY)
        lens.delay = g_value_get_uint(value);
    else if (id == PROP_LAG)
        lens.lag = g_value_get_double(value);
    else if (id == PROP_ECHO)
        lens.echo = g_value_get_boolean(value);
    else
        gst_base_src_set_live(GST_BASE_SRC(object), g_value_get_boolean(value));
}

static void get_property(GObject *object, guint id, GValue *value, GParamSpec *)
{
    LateLens &lens = lens_of(object);
    const std::lock_guard lock(lens.mutex);
    if (id == PROP_LENS_POSITION)
        g_value_set_float(value, static_cast<gfloat>(lens.echo ? lens.set : lens.told));
    else if (id == PROP_AF_MODE)
        g_value_set_enum(value, lens.manual ? MODE_MANUAL : MODE_AUTO);
}

static GstFlowReturn create(GstPushSrc *source, GstBuffer **buffer)
{
    LateLens &lens = lens_of(source);
    *buffer = gst_buffer_new_allocate(nullptr, width * height, nullptr);
    const double position = lens.expose();
    GstMapInfo map;
    gst_buffer_map(*buffer, &map, GST_MAP_WRITE);
    draw(map.data, position, lens.noise);
    gst_buffer_unmap(*buffer, &map);
    return GST_FLOW_OK;
}

static void finalize(GObject *object)
{
    delete reinterpret_cast<LateLensSrc *>(object)->lens;
    G_OBJECT_CLASS(late_lens_src_parent_class)->finalize(object);
}

static void late_lens_src_init(LateLensSrc *self)
{
    self->lens = new LateLens;
    gst_base_src_set_format(GST_BASE_SRC(self), GST_FORMAT_TIME);
}

static GstStaticPadTemplate src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS,
    GST_STATIC_CAPS("video/x-raw,format=GRAY8,width=96,height=64,framerate=[1/1,10000/1]"));

static void late_lens_src_class_init(LateLensSrcClass *klass)
{
    auto *object_class = G_OBJECT_CLASS(klass);
    object_class->set_property = set_property;
    object_class->get_property = get_property;
    object_class->finalize = finalize;
    constexpr auto flags = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS);
    constexpr auto write = static_cast<GParamFlags>(G_PARAM_WRITABLE | G_PARAM_STATIC_STRINGS);
    g_object_class_install_property(
        object_class, PROP_LENS_POSITION,
        g_param_spec_float("lens-position", "", "", 0.0F, static_cast<gfloat>(nearest), 1.0F, flags));
    g_object_class_install_property(
        object_class, PROP_AF_MODE,
        g_param_spec_enum("af-mode", "", "", af_mode_get_type(), MODE_AUTO, flags));
    g_object_class_install_property(object_class, PROP_DELAY,
                                    g_param_spec_uint("delay", "", "", 0, 5, 2, write));
    g_object_class_install_property(object_class, PROP_LAG,
                                    g_param_spec_double("lag", "", "", 0, 100, 0, write));
    g_object_class_install_property(object_class, PROP_ECHO,
                                    g_param_spec_boolean("echo", "", "", FALSE, write));
    g_object_class_install_property(object_class, PROP_LIVE,
                                    g_param_spec_boolean("live", "", "", FALSE, write));
    gst_element_class_add_static_pad_template(GST_ELEMENT_CLASS(klass), &src_template);
    gst_element_class_set_static_metadata(GST_ELEMENT_CLASS(klass), "Late lens", "Source", "For tests",
                                          "the gst-plugins-dff authors");
    GST_PUSH_SRC_CLASS(klass)->create = create;
}

void register_late_lens_source()
{
    static std::once_flag once;
    std::call_once(
        once, [] { gst_element_register(nullptr, "latelenssrc", GST_RANK_NONE, late_lens_src_get_type()); });
}

double true_position(GstBuffer *frame)
{
    double position = NAN;
    gst_buffer_extract(frame, 0, &position, sizeof position);
    return position;
}
