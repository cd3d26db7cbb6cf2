/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-depthplyenc
 * @title: depthplyenc
 * @short_description: colour and depth as point clouds
 *
 * Writes each frame as a binary PLY file: a point with its colour for every pixel whose distance is known and
 * finite; x points right, y down, z away from the camera, in metres. MeshLab, Open3D, CloudCompare and others
 * open it.
 *
 * The camera's intrinsics come from a `calibration` file or from the GstDepthMeta (see calibration of
 * dffdepth), the distances from a depth in dioptres or millimetres. Put a queue on every branch.
 *
 * A microscope sees the same size at every distance: projection=orthographic with pixel-size, and a depth in
 * micrometres, give a cloud in micrometres, with x and y from the picture's centre and z the stage position,
 * or its negative where the stage's positions fall from the nearest plane to the farthest.
 *
 * With dffdepth's `uncertainty` on the request pad of that name each point has a property `uncertainty`: one
 * standard deviation of z, in what z is in, NaN where it is unknown. Viewers show it as colours, or leave out
 * what is too uncertain.
 *
 * ## Example launch line
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=6 near=5 far=0.5 ! video/x-raw,width=320,height=240 ! \
 *     focalstackmux ! tee name=s  s. ! queue ! dffdepth calibration=camera.yml ! tee name=d \
 *     d. ! queue ! c.depth  s. ! queue ! c.stack  aifcompose name=c ! videoconvert ! queue ! e.color \
 *     d. ! queue ! e.depth  depthplyenc name=e ! multifilesink location=points-%02d.ply
 * ]|
 */
#include "depthplyenc.h"

#include "distance_table.h"
#include "mapped_picture.h"
#include "optics/camera_calibration.h"
#include "point_cloud.h"
#include "stream_depth.h"

#include <optional>
#include <stdexcept>
#include <string>

GST_DEBUG_CATEGORY_STATIC(gst_depth_ply_enc_debug);
#define GST_CAT_DEFAULT gst_depth_ply_enc_debug

static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS("application/x-ply"));

namespace {

enum Property : guint {
    PropertyCalibration = 1,
    PropertyStride,
    PropertyMaxDistance,
    PropertyProjection,
    PropertyPixelSize
};

struct Settings {
    GstDepthPlyEncProjection projection = GST_DEPTH_PLY_ENC_PROJECTION_PERSPECTIVE;
    double pixel_size_um = 0.0;
    std::string calibration;
    guint stride = 1;
    double max_distance = G_MAXDOUBLE;
};

/* Where the points of the pixels lie, for one camera. */
struct CameraPoints {
    dff::CameraCalibration camera;
    guint stride;
    double pixel_size_um; /* 0: the camera sees in perspective */
    dff::PointCloud cloud;
};

struct State {
    Settings settings; /* guarded by the object lock */

    /* The streaming thread's own. */
    std::optional<dff::CameraCalibration> calibration;
    std::optional<CameraPoints> points;
    std::optional<dff::DepthScale> scale;
    std::vector<float> distances, slopes; /* of `scale` */
};

constexpr char unknown_distances[] =
    "Points need distances, but the depth is in plane numbers or stage positions: give near and far to the "
    "source or to lenssweeptag, and unit=dioptre to dffdepth";
constexpr char unknown_heights[] =
    "Points need heights, but the depth is in plane numbers: give positions or step-um to lenssweeptag, and "
    "unit=micrometre to dffdepth";

dff::CameraCalibration camera_of(const GstDepthInfo &depth, unsigned width, unsigned height)
{
    if (!depth.has_intrinsics)
        throw std::runtime_error(
            "The camera's intrinsics are not known: set calibration here or on dffdepth");
    return {width,
            height,
            depth.fx,
            depth.fy,
            depth.cx,
            depth.cy,
            {depth.distortion[0], depth.distortion[1], depth.distortion[2], depth.distortion[3],
             depth.distortion[4]}};
}

} // namespace

struct _GstDepthPlyEnc {
    GstDepthFileEnc parent;
    State *state;
};

G_DEFINE_FINAL_TYPE(GstDepthPlyEnc, gst_depth_ply_enc, GST_TYPE_DEPTH_FILE_ENC)
GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(depthplyenc, "depthplyenc", GST_RANK_NONE, GST_TYPE_DEPTH_PLY_ENC,
                                      GST_DEBUG_CATEGORY_INIT(gst_depth_ply_enc_debug, "depthplyenc", 0,
                                                              "point clouds"))

GType gst_depth_ply_enc_projection_get_type()
{
    static const GEnumValue values[] = {
        {GST_DEPTH_PLY_ENC_PROJECTION_PERSPECTIVE, "By the camera's intrinsics, in metres", "perspective"},
        {GST_DEPTH_PLY_ENC_PROJECTION_ORTHOGRAPHIC, "Telecentric, as a microscope: in micrometres",
         "orthographic"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_enum_register_static("GstDepthPlyEncProjection", values);
    return type;
}

static Settings settings_of(GstDepthPlyEnc *self)
{
    GST_OBJECT_LOCK(self);
    Settings settings = self->state->settings;
    GST_OBJECT_UNLOCK(self);
    return settings;
}

/* A cloud's z points away from the camera, whichever way the stage counts. */
static void turn_away(std::vector<float> &heights)
{
    for (float &height : heights)
        height = -height;
}

static void prepare_distances(State &state, const dff::DepthScale &scale, bool orthographic)
{
    const bool in_distances =
        scale.unit == dff::DepthUnit::Dioptre || scale.unit == dff::DepthUnit::Millimetre;
    const bool in_heights = scale.unit == dff::DepthUnit::Micrometre;
    if (!in_distances && !(in_heights && orthographic))
        throw std::runtime_error(orthographic ? unknown_heights : unknown_distances);
    if (state.scale == scale)
        return;
    state.distances = dff::distance_table(scale);
    state.slopes = dff::distance_slope_table(scale);
    if (in_heights && scale.scale < 0.0)
        turn_away(state.distances);
    state.scale = scale;
}

static dff::CameraCalibration seen_by(const State &state, const GstDepthInfo &facts,
                                      const dff::PictureView &view, bool orthographic)
{
    if (orthographic)
        return {.width = view.width, .height = view.height};
    return state.calibration ? state.calibration->scaled_to(view.width, view.height)
                             : camera_of(facts, view.width, view.height);
}

static void prepare_points(State &state, const dff::CameraCalibration &camera, guint stride,
                           double pixel_size_um)
{
    if (state.points && state.points->camera == camera && state.points->stride == stride &&
        state.points->pixel_size_um == pixel_size_um)
        return;
    state.points.emplace(
        CameraPoints{camera, stride, pixel_size_um,
                     pixel_size_um > 0.0
                         ? dff::PointCloud::orthographic(camera.width, camera.height, pixel_size_um, stride)
                         : dff::PointCloud(camera, stride)});
}

static std::vector<guint8> encode(GstDepthFileEnc *encoder, const dff::FrameSet &frames)
{
    auto *self = GST_DEPTH_PLY_ENC(encoder);
    State &state = *self->state;
    const Settings settings = settings_of(self);
    const dff::MappedPicture colour(frames.colour, *frames.colour_info);
    const dff::MappedPicture depth(frames.depth, *frames.depth_info);
    const dff::PictureView view = depth.view();

    const GstDepthInfo facts = dff::depth_of(frames.depth, frames.depth_caps);
    const bool orthographic = settings.projection == GST_DEPTH_PLY_ENC_PROJECTION_ORTHOGRAPHIC;
    if (orthographic && !(settings.pixel_size_um > 0.0))
        throw std::runtime_error(
            "projection=orthographic needs pixel-size: how many micrometres of the scene "
            "a pixel shows");
    prepare_distances(state, dff::scale_of(facts), orthographic);
    prepare_points(state, seen_by(state, facts, view, orthographic), settings.stride,
                   orthographic ? settings.pixel_size_um : 0.0);
    if (!frames.uncertainty)
        return state.points->cloud.write(colour.view(), view, state.distances, settings.max_distance);
    const dff::MappedPicture deviations(frames.uncertainty, *frames.uncertainty_info);
    const dff::DepthUncertainty uncertainty{deviations.view(), state.slopes};
    return state.points->cloud.write(colour.view(), view, state.distances, settings.max_distance,
                                     &uncertainty);
}

static gboolean start(GstAggregator *aggregator)
{
    auto *self = GST_DEPTH_PLY_ENC(aggregator);
    const std::string file = settings_of(self).calibration;
    self->state->calibration.reset();
    try {
        if (!file.empty())
            self->state->calibration = dff::read_camera_calibration(file);
    } catch (const std::runtime_error &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS, ("%s", error.what()), (nullptr));
        return FALSE;
    }
    return GST_AGGREGATOR_CLASS(gst_depth_ply_enc_parent_class)->start(aggregator);
}

static void set_property(GObject *object, guint id, const GValue *value, GParamSpec *pspec)
{
    Settings &settings = GST_DEPTH_PLY_ENC(object)->state->settings;
    GST_OBJECT_LOCK(object);
    if (id == PropertyCalibration)
        settings.calibration = g_value_get_string(value) ? g_value_get_string(value) : "";
    else if (id == PropertyStride)
        settings.stride = g_value_get_uint(value);
    else if (id == PropertyMaxDistance)
        settings.max_distance = g_value_get_double(value);
    else if (id == PropertyProjection)
        settings.projection = static_cast<GstDepthPlyEncProjection>(g_value_get_enum(value));
    else if (id == PropertyPixelSize)
        settings.pixel_size_um = g_value_get_double(value);
    else
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
    GST_OBJECT_UNLOCK(object);
}

static void get_property(GObject *object, guint id, GValue *value, GParamSpec *pspec)
{
    const Settings settings = settings_of(GST_DEPTH_PLY_ENC(object));
    if (id == PropertyCalibration)
        g_value_set_string(value, settings.calibration.c_str());
    else if (id == PropertyStride)
        g_value_set_uint(value, settings.stride);
    else if (id == PropertyMaxDistance)
        g_value_set_double(value, settings.max_distance);
    else if (id == PropertyProjection)
        g_value_set_enum(value, settings.projection);
    else if (id == PropertyPixelSize)
        g_value_set_double(value, settings.pixel_size_um);
    else
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void finalize(GObject *object)
{
    delete GST_DEPTH_PLY_ENC(object)->state;
    G_OBJECT_CLASS(gst_depth_ply_enc_parent_class)->finalize(object);
}

static void gst_depth_ply_enc_init(GstDepthPlyEnc *self)
{
    self->state = new State;
}

static void install_properties(GObjectClass *object_class)
{
    const Settings defaults;
    constexpr auto playing =
        static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_PLAYING);
    constexpr auto ready =
        static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY);
    g_object_class_install_property(
        object_class, PropertyCalibration,
        g_param_spec_string(
            "calibration", "Calibration",
            "File of the camera's calibration as OpenCV writes it (camera_matrix, "
            "distortion_coefficients, image_width, image_height), for whole pictures of any size; "
            "empty: the intrinsics of the GstDepthMeta",
            "", ready));
    g_object_class_install_property(object_class, PropertyStride,
                                    g_param_spec_uint("stride", "Stride",
                                                      "A point for every this many pixels in each direction",
                                                      1, 1024, defaults.stride, playing));
    g_object_class_install_property(
        object_class, PropertyMaxDistance,
        g_param_spec_double("max-distance", "Max distance",
                            "Metres along the camera's axis beyond which there are no points", 0.0,
                            G_MAXDOUBLE, defaults.max_distance, playing));
    g_object_class_install_property(object_class, PropertyProjection,
                                    g_param_spec_enum("projection", "Projection", "How the camera sees",
                                                      GST_TYPE_DEPTH_PLY_ENC_PROJECTION, defaults.projection,
                                                      playing));
    g_object_class_install_property(
        object_class, PropertyPixelSize,
        g_param_spec_double(
            "pixel-size", "Pixel size",
            "projection=orthographic: micrometres from pixel to pixel in the scene, which are "
            "those of the sensor over the magnification",
            0.0, 1e6, defaults.pixel_size_um, playing));
}

static void gst_depth_ply_enc_class_init(GstDepthPlyEncClass *klass)
{
    auto *object_class = G_OBJECT_CLASS(klass);
    auto *element_class = GST_ELEMENT_CLASS(klass);

    object_class->set_property = set_property;
    object_class->get_property = get_property;
    object_class->finalize = finalize;
    install_properties(object_class);
    GST_AGGREGATOR_CLASS(klass)->start = start;
    GST_DEPTH_FILE_ENC_CLASS(klass)->encode = encode;
    gst_element_class_add_static_pad_template_with_gtype(element_class, &src_template,
                                                         GST_TYPE_AGGREGATOR_PAD);
    gst_element_class_set_static_metadata(element_class, "PLY encoder", "Codec/Encoder/Image",
                                          "Writes colour and depth as point clouds",
                                          "the gst-plugins-dff authors");
    gst_type_mark_as_plugin_api(GST_TYPE_DEPTH_PLY_ENC_PROJECTION, static_cast<GstPluginAPIFlags>(0));
}
