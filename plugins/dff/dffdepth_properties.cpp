/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "dffdepth_properties.h"

namespace dff {

namespace {

namespace property {
enum : guint {
    Unit = 1,
    Device,
    Method,
    Scale,
    Levels,
    Tolerance,
    MotionMask,
    EntropyBits,
    SigmaXy,
    SigmaLuma,
    SigmaChroma,
    Lambda,
    Iterations,
    Calibration,
    Steady,
    Prefer,
    End,
};
} // namespace property
static_assert(property::End == depth_properties_end);

constexpr auto playing =
    static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_PLAYING);
constexpr auto ready =
    static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY);

#define GST_TYPE_DEPTH_METHOD (gst_depth_method_get_type())

GType gst_depth_method_get_type()
{
    static const GEnumValue values[] = {
        {static_cast<int>(Method::Volume), "Spreads the evidence of focus, then decides: more accurate",
         "volume"},
        {static_cast<int>(Method::Paper), "Oliva-García 2022: decides for each pixel, then fills: faster",
         "paper"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_enum_register_static("GstDepthMethod", values);
    return type;
}

#define GST_TYPE_DEPTH_PREFERENCE (gst_depth_preference_get_type())

GType gst_depth_preference_get_type()
{
    static const GEnumValue values[] = {
        {static_cast<int>(Prefer::Clearest), "The one of which there is more to see", "clearest"},
        {static_cast<int>(Prefer::Near), "The nearer one", "near"},
        {static_cast<int>(Prefer::Far), "The farther one", "far"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_enum_register_static("GstDepthPreference", values);
    return type;
}

#define GST_TYPE_DEPTH_STEADINESS (gst_depth_steadiness_get_type())

GType gst_depth_steadiness_get_type()
{
    static const GEnumValue values[] = {
        {static_cast<int>(Steadiness::Auto), "Where the source is live", "auto"},
        {static_cast<int>(Steadiness::Off), "Each stack is computed as if it were the only one", "off"},
        {static_cast<int>(Steadiness::On), "Always", "on"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_enum_register_static("GstDepthSteadiness", values);
    return type;
}

} // namespace

void install_depth_properties(GObjectClass *object_class)
{
    const DepthSettings defaults;
    const DepthParameters &p = defaults.parameters;
    const auto install = [&](guint id, GParamSpec *spec) {
        g_object_class_install_property(object_class, id, spec);
    };

    install(
        property::Unit,
        g_param_spec_enum("unit", "Unit",
                          "Unit of the depth map; auto is dioptre where the planes' powers are known, else "
                          "index",
                          GST_TYPE_DEPTH_UNIT, defaults.unit, playing));
    install(property::Device,
            g_param_spec_string("device", "Device",
                                "Part of the name of the OpenCL device to compute on, as clinfo -l lists it; "
                                "empty: the one that the application or a neighbour shares, else the first "
                                "GPU, else the CPU",
                                defaults.device.c_str(), ready));
    install(property::Method, g_param_spec_enum("method", "Method", "How a stack becomes depth",
                                                GST_TYPE_DEPTH_METHOD, static_cast<int>(p.method), playing));
    install(property::Scale,
            g_param_spec_uint(
                "scale", "Scale",
                "Of method=volume: pixels of the stack a cell of the volume in each direction: 2, 4 "
                "or 8; 0 = 2 up to 800x600 and 4 above",
                0, 8, p.scale, playing));
    install(
        property::Levels,
        g_param_spec_uint("levels", "Levels",
                          "Pictures of falling resolution that the focus measure multiplies (the paper: 3); "
                          "more keep less noise and less detail",
                          1, 4, p.levels, playing));
    install(property::Tolerance,
            g_param_spec_float("tolerance", "Tolerance",
                               "How many times above its mean over the planes a pixel's best response must "
                               "stand to be kept",
                               1.0f, 64.0f, p.tolerance, playing));
    install(property::MotionMask,
            g_param_spec_boolean("motion-mask", "Motion mask",
                                 "Leave pixels that moved during the sweep out of the sparse depth",
                                 p.motion_mask, playing));
    install(property::EntropyBits,
            g_param_spec_float(
                "entropy-bits", "Entropy bits",
                "Entropy of a pixel's luma along the planes, in bits over bins of 16 DN, above which it "
                "moved during the sweep; it cannot exceed log2 of the planes. 2 finds a third of the "
                "moving pixels and takes one in a hundred still ones for moving, 1.5 two thirds and six "
                "in a hundred",
                0.0f, 4.0f, p.entropy_bits, playing));
    install(property::SigmaXy,
            g_param_spec_uint("sigma-xy", "Sigma xy",
                              "How far depth spreads into unknown pixels: size of a bilateral cell in pixels",
                              4, 256, p.grid.sigma_xy, playing));
    install(property::SigmaLuma,
            g_param_spec_uint("sigma-luma", "Sigma luma",
                              "Across which luma edges depth spreads: size of a bilateral cell in DN of 8 "
                              "bits",
                              4, 256, p.grid.sigma_luma, playing));
    install(property::SigmaChroma,
            g_param_spec_uint("sigma-chroma", "Sigma chroma",
                              "Across which chroma edges depth spreads, in DN of 8 bits; 0: chroma is not "
                              "looked at. The cost grows with (256 / sigma-chroma)^2",
                              0, 256, p.grid.sigma_chroma, playing));
    install(property::Lambda,
            g_param_spec_float("lambda", "Lambda", "Weight of smoothness against the sparse depth", 0.0f,
                               1000.0f, p.grid.lambda, playing));
    install(property::Iterations,
            g_param_spec_uint("iterations", "Iterations", "Steps of the solver that fills unknown pixels", 0,
                              1000, p.grid.iterations, playing));
    install(
        property::Calibration,
        g_param_spec_string("calibration", "Calibration",
                            "File of the camera's calibration as OpenCV writes it (camera_matrix, "
                            "distortion_coefficients, image_width, image_height), for whole pictures of any "
                            "size: the GstDepthMeta tells the intrinsics; a file of dff-calibrate also says "
                            "where the planes are sharp, "
                            "curved field included, whatever the stack says; empty: nothing is known",
                            "", ready));
    install(
        property::Steady,
        g_param_spec_enum("steady", "Steady",
                          "Keeps depth from flickering where the picture stands still: the mean of up to 16 "
                          "stacks. What moves has the depth of the last stack alone",
                          GST_TYPE_DEPTH_STEADINESS, static_cast<int>(defaults.steady), playing));
    install(property::Prefer,
            g_param_spec_enum("prefer", "Prefer",
                              "Of method=volume: what has the depth where something farther is seen through "
                              "something thin and near, as hairs or a net",
                              GST_TYPE_DEPTH_PREFERENCE, static_cast<int>(p.prefer), playing));
}

bool set_depth_property(DepthSettings &settings, guint id, const GValue *value)
{
    DepthParameters &p = settings.parameters;
    switch (id) {
    case property::Unit:
        settings.unit = static_cast<GstDepthUnit>(g_value_get_enum(value));
        return true;
    case property::Device:
        settings.device = g_value_get_string(value) ? g_value_get_string(value) : "";
        return true;
    case property::Method:
        p.method = static_cast<Method>(g_value_get_enum(value));
        return true;
    case property::Scale:
        p.scale = g_value_get_uint(value);
        return true;
    case property::Levels:
        p.levels = g_value_get_uint(value);
        return true;
    case property::Tolerance:
        p.tolerance = g_value_get_float(value);
        return true;
    case property::MotionMask:
        p.motion_mask = g_value_get_boolean(value);
        return true;
    case property::EntropyBits:
        p.entropy_bits = g_value_get_float(value);
        return true;
    case property::SigmaXy:
        p.grid.sigma_xy = g_value_get_uint(value);
        return true;
    case property::SigmaLuma:
        p.grid.sigma_luma = g_value_get_uint(value);
        return true;
    case property::SigmaChroma:
        p.grid.sigma_chroma = g_value_get_uint(value);
        return true;
    case property::Lambda:
        p.grid.lambda = g_value_get_float(value);
        return true;
    case property::Iterations:
        p.grid.iterations = g_value_get_uint(value);
        return true;
    case property::Steady:
        settings.steady = static_cast<Steadiness>(g_value_get_enum(value));
        return true;
    case property::Prefer:
        p.prefer = static_cast<Prefer>(g_value_get_enum(value));
        return true;
    case property::Calibration:
        settings.calibration = g_value_get_string(value) ? g_value_get_string(value) : "";
        return true;
    default:
        return false;
    }
}

bool get_depth_property(const DepthSettings &settings, guint id, GValue *value)
{
    const DepthParameters &p = settings.parameters;
    switch (id) {
    case property::Unit:
        g_value_set_enum(value, settings.unit);
        return true;
    case property::Device:
        g_value_set_string(value, settings.device.c_str());
        return true;
    case property::Method:
        g_value_set_enum(value, static_cast<int>(p.method));
        return true;
    case property::Scale:
        g_value_set_uint(value, p.scale);
        return true;
    case property::Levels:
        g_value_set_uint(value, p.levels);
        return true;
    case property::Tolerance:
        g_value_set_float(value, p.tolerance);
        return true;
    case property::MotionMask:
        g_value_set_boolean(value, p.motion_mask);
        return true;
    case property::EntropyBits:
        g_value_set_float(value, p.entropy_bits);
        return true;
    case property::SigmaXy:
        g_value_set_uint(value, p.grid.sigma_xy);
        return true;
    case property::SigmaLuma:
        g_value_set_uint(value, p.grid.sigma_luma);
        return true;
    case property::SigmaChroma:
        g_value_set_uint(value, p.grid.sigma_chroma);
        return true;
    case property::Lambda:
        g_value_set_float(value, p.grid.lambda);
        return true;
    case property::Iterations:
        g_value_set_uint(value, p.grid.iterations);
        return true;
    case property::Steady:
        g_value_set_enum(value, static_cast<int>(settings.steady));
        return true;
    case property::Prefer:
        g_value_set_enum(value, static_cast<int>(p.prefer));
        return true;
    case property::Calibration:
        g_value_set_string(value, settings.calibration.c_str());
        return true;
    default:
        return false;
    }
}

} // namespace dff
