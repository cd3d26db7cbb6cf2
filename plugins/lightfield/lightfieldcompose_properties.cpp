/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lightfieldcompose_properties.h"

#include "display_preset.h"

#include <glib-object.h>
#include <numbers>
#include <vector>

namespace dff {

namespace {

namespace property {
enum : guint {
    Layout = 1,
    Preset,
    Columns,
    Rows,
    ViewAspect,
    ViewCone,
    ZeroParallax,
    ZeroParallaxDioptre,
    DepthGain,
    InvertDepth,
    DepthSide,
    Fill,
    DisplayCalibration,
    Pitch,
    Gap,
    Grid,
    Rotation,
    CenterX,
    CenterY,
    FlipLenses,
    End,
};
} // namespace property
static_assert(property::End == light_field_properties_end);

constexpr double degree = std::numbers::pi / 180.0;
constexpr auto playing =
    static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_PLAYING);
constexpr auto ready =
    static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY);

GType layout_type()
{
    static const GEnumValue values[] = {
        {static_cast<int>(LightFieldLayout::Quilt),
         "Views in columns and rows, the leftmost at the bottom left", "quilt"},
        {static_cast<int>(LightFieldLayout::Rgbd), "Colour, and depth on the depth-side of it", "rgbd"},
        {static_cast<int>(LightFieldLayout::Lenticular), "Pixels of a panel under slanted cylindrical lenses",
         "lenticular"},
        {static_cast<int>(LightFieldLayout::Elemental), "Pixels of a panel under an array of round lenses",
         "elemental"},
        {static_cast<int>(LightFieldLayout::Views),
         "Views in columns and rows, the leftmost at the top left; two are stereo", "views"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_enum_register_static("GstLightFieldLayout", values);
    return type;
}

GType depth_side_type()
{
    static const GEnumValue values[] = {
        {static_cast<int>(DepthSide::Right), "Depth on the right of the colour", "right"},
        {static_cast<int>(DepthSide::Left), "Depth on the left", "left"},
        {static_cast<int>(DepthSide::Below), "Depth below", "below"},
        {static_cast<int>(DepthSide::Above), "Depth above", "above"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_enum_register_static("GstLightFieldDepthSide", values);
    return type;
}

GType preset_type()
{
    static const std::vector<GEnumValue> values = [] {
        std::vector<GEnumValue> list{{0, "Columns, rows and aspect as they are set", "none"}};
        for (const DisplayPreset &preset : display_presets())
            list.push_back({static_cast<gint>(list.size()), preset.name, preset.nick});
        list.push_back({0, nullptr, nullptr});
        return list;
    }();
    static const GType type = g_enum_register_static("GstLightFieldPreset", values.data());
    return type;
}

GType fill_type()
{
    static const GEnumValue values[] = {
        {0, "Black", "none"},
        {1, "The background around them goes on", "background"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_enum_register_static("GstLightFieldFill", values);
    return type;
}

GType grid_type()
{
    static const GEnumValue values[] = {
        {static_cast<int>(LensGrid::Square), "Lenses in columns and rows", "square"},
        {static_cast<int>(LensGrid::Hexagonal), "Every second row shifted by half a lens", "hex"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_enum_register_static("GstLightFieldGrid", values);
    return type;
}

void apply_preset(LightFieldSettings &settings, size_t index)
{
    settings.preset = index;
    if (index == 0) {
        settings.quilt = {0, 0};
        return;
    }
    const DisplayPreset &preset = display_presets()[index - 1];
    settings.parameters.columns = preset.columns;
    settings.parameters.rows = preset.rows;
    settings.parameters.view_aspect = preset.aspect;
    settings.quilt = preset.quilt;
}

void install_view_properties(GObjectClass *klass, const LightFieldSettings &defaults)
{
    const auto install = [klass](guint id, GParamSpec *spec) {
        g_object_class_install_property(klass, id, spec);
    };
    const LightFieldParameters &p = defaults.parameters;
    install(property::Layout, g_param_spec_enum("layout", "Layout", "What the display takes", layout_type(),
                                                static_cast<int>(p.layout), playing));
    install(property::Preset,
            g_param_spec_enum(
                "preset", "Preset",
                "Display that a quilt is for: sets columns, rows, view-aspect and the size of the quilt "
                "where downstream takes any",
                preset_type(), 0, playing));
    install(property::Columns,
            g_param_spec_uint("columns", "Columns", "Views in a row; 0: 8 in a quilt, 2 of layout=views", 0,
                              64, p.columns, playing));
    install(property::Rows,
            g_param_spec_uint("rows", "Rows", "Rows of views; 0: 6 in a quilt, 1 of layout=views", 0, 64,
                              p.rows, playing));
    install(property::ViewAspect,
            g_param_spec_double(
                "view-aspect", "View aspect",
                "Width by height of a view of a quilt or of layout=views, which the middle of the picture "
                "is cut out to; 0: that of the picture",
                0.0, 16.0, p.view_aspect, playing));
    install(property::ViewCone,
            g_param_spec_double(
                "view-cone", "View cone",
                "Angle between the outermost views in degrees; 0: that of the display-calibration, else 40",
                0.0, 120.0, defaults.view_cone, playing));
    install(property::ZeroParallax,
            g_param_spec_double(
                "zero-parallax", "Zero parallax",
                "Depth that lies in the plane of the display, the same in all views: 0 is the sweep's near "
                "end, 1 its far end, linear in dioptres",
                0.0, 1.0, p.zero_parallax, playing));
    install(property::ZeroParallaxDioptre,
            g_param_spec_double(
                "zero-parallax-dioptre", "Zero parallax in dioptres",
                "The same in dioptres, where the depth's range is known; -1: as zero-parallax says", -1.0,
                1000.0, defaults.zero_parallax_dioptre, playing));
    install(property::DepthGain,
            g_param_spec_double(
                "depth-gain", "Depth gain",
                "How deep the sweep from its near to its far end looks on the display, in widths of a "
                "view; 0 is flat",
                0.0, 10.0, p.depth_gain, playing));
    install(property::InvertDepth,
            g_param_spec_boolean("invert-depth", "Invert depth",
                                 "In layout=rgbd: near is black instead of white", p.invert_depth, playing));
    install(property::DepthSide,
            g_param_spec_enum("depth-side", "Depth side",
                              "Of layout=rgbd: where depth is, seen from the colour", depth_side_type(),
                              static_cast<int>(p.depth_side), playing));
    install(property::Fill,
            g_param_spec_enum("fill", "Fill", "What is shown where a view sees behind an edge", fill_type(),
                              p.fill, playing));
}

void install_lens_properties(GObjectClass *klass, const LightFieldSettings &defaults)
{
    const auto install = [klass](guint id, GParamSpec *spec) {
        g_object_class_install_property(klass, id, spec);
    };
    const LensArray &lenses = defaults.parameters.lenses;
    install(property::DisplayCalibration,
            g_param_spec_string(
                "display-calibration", "Display calibration",
                "For layout=lenticular: path of a JSON or YAML file with the fields of Looking Glass "
                "displays: screenW, screenH, DPI, pitch, slope, center, and if need be invView, "
                "flipImageX, flipImageY, flipSubp, viewCone, each a number or {\"value\": number}, "
                "subpixelCells and CellPatternMode",
                "", ready));
    install(property::Pitch,
            g_param_spec_double("pitch", "Pitch",
                                "Of layout=elemental: distance of the lenses in pixels of the panel", 1.0,
                                4096.0, lenses.pitch, playing));
    install(property::Gap,
            g_param_spec_double(
                "gap", "Gap",
                "Of layout=elemental: distance from panel to lenses in pixels of the panel; 0: such that "
                "what is behind a lens fans out over view-cone",
                0.0, 65536.0, lenses.gap, playing));
    install(property::Grid, g_param_spec_enum("grid", "Grid", "Of layout=elemental: how the lenses stand",
                                              grid_type(), static_cast<int>(lenses.grid), playing));
    install(property::Rotation,
            g_param_spec_double("rotation", "Rotation",
                                "Of layout=elemental: turn of the lenses' rows in degrees, clockwise", -180.0,
                                180.0, lenses.rotation / degree, playing));
    install(property::CenterX,
            g_param_spec_double(
                "center-x", "Center x",
                "Of layout=elemental: middle of one lens, pixels to the right of the panel's middle",
                -65536.0, 65536.0, lenses.center.x, playing));
    install(property::CenterY,
            g_param_spec_double("center-y", "Center y",
                                "Of layout=elemental: middle of one lens, pixels below the panel's middle",
                                -65536.0, 65536.0, lenses.center.y, playing));
    install(property::FlipLenses,
            g_param_spec_boolean(
                "flip-lenses", "Flip lenses",
                "Of layout=elemental: turn the picture behind each lens by half a turn. Computed pictures "
                "need none; it is for those captured through lenses",
                lenses.flip, playing));
}

bool set_lens_property(LightFieldSettings &settings, guint id, const GValue *value)
{
    LensArray &lenses = settings.parameters.lenses;
    switch (id) {
    case property::DisplayCalibration:
        settings.calibration = g_value_get_string(value) ? g_value_get_string(value) : "";
        return true;
    case property::Pitch:
        lenses.pitch = g_value_get_double(value);
        return true;
    case property::Gap:
        lenses.gap = g_value_get_double(value);
        return true;
    case property::Grid:
        lenses.grid = static_cast<LensGrid>(g_value_get_enum(value));
        return true;
    case property::Rotation:
        lenses.rotation = g_value_get_double(value) * degree;
        return true;
    case property::CenterX:
        lenses.center.x = g_value_get_double(value);
        return true;
    case property::CenterY:
        lenses.center.y = g_value_get_double(value);
        return true;
    case property::FlipLenses:
        lenses.flip = g_value_get_boolean(value);
        return true;
    default:
        return false;
    }
}

bool get_lens_property(const LightFieldSettings &settings, guint id, GValue *value)
{
    const LensArray &lenses = settings.parameters.lenses;
    switch (id) {
    case property::DisplayCalibration:
        g_value_set_string(value, settings.calibration.c_str());
        return true;
    case property::Pitch:
        g_value_set_double(value, lenses.pitch);
        return true;
    case property::Gap:
        g_value_set_double(value, lenses.gap);
        return true;
    case property::Grid:
        g_value_set_enum(value, static_cast<int>(lenses.grid));
        return true;
    case property::Rotation:
        g_value_set_double(value, lenses.rotation / degree);
        return true;
    case property::CenterX:
        g_value_set_double(value, lenses.center.x);
        return true;
    case property::CenterY:
        g_value_set_double(value, lenses.center.y);
        return true;
    case property::FlipLenses:
        g_value_set_boolean(value, lenses.flip);
        return true;
    default:
        return false;
    }
}

} // namespace

void install_light_field_properties(GObjectClass *object_class)
{
    LightFieldSettings defaults;
    install_view_properties(object_class, defaults);
    install_lens_properties(object_class, defaults);
    for (const GType type : {layout_type(), depth_side_type(), preset_type(), fill_type(), grid_type()})
        gst_type_mark_as_plugin_api(type, static_cast<GstPluginAPIFlags>(0));
}

bool set_light_field_property(LightFieldSettings &settings, guint id, const GValue *value)
{
    LightFieldParameters &p = settings.parameters;
    switch (id) {
    case property::Layout:
        p.layout = static_cast<LightFieldLayout>(g_value_get_enum(value));
        return true;
    case property::Preset:
        apply_preset(settings, static_cast<size_t>(g_value_get_enum(value)));
        return true;
    case property::Columns:
        p.columns = g_value_get_uint(value);
        return true;
    case property::Rows:
        p.rows = g_value_get_uint(value);
        return true;
    case property::ViewAspect:
        p.view_aspect = g_value_get_double(value);
        return true;
    case property::ViewCone:
        settings.view_cone = g_value_get_double(value);
        return true;
    case property::ZeroParallax:
        p.zero_parallax = g_value_get_double(value);
        return true;
    case property::ZeroParallaxDioptre:
        settings.zero_parallax_dioptre = g_value_get_double(value);
        return true;
    case property::DepthGain:
        p.depth_gain = g_value_get_double(value);
        return true;
    case property::InvertDepth:
        p.invert_depth = g_value_get_boolean(value);
        return true;
    case property::DepthSide:
        p.depth_side = static_cast<DepthSide>(g_value_get_enum(value));
        return true;
    case property::Fill:
        p.fill = g_value_get_enum(value) != 0;
        return true;
    default:
        return set_lens_property(settings, id, value);
    }
}

bool get_light_field_property(const LightFieldSettings &settings, guint id, GValue *value)
{
    const LightFieldParameters &p = settings.parameters;
    switch (id) {
    case property::Layout:
        g_value_set_enum(value, static_cast<int>(p.layout));
        return true;
    case property::Preset:
        g_value_set_enum(value, static_cast<int>(settings.preset));
        return true;
    case property::Columns:
        g_value_set_uint(value, p.columns);
        return true;
    case property::Rows:
        g_value_set_uint(value, p.rows);
        return true;
    case property::ViewAspect:
        g_value_set_double(value, p.view_aspect);
        return true;
    case property::ViewCone:
        g_value_set_double(value, settings.view_cone);
        return true;
    case property::ZeroParallax:
        g_value_set_double(value, p.zero_parallax);
        return true;
    case property::ZeroParallaxDioptre:
        g_value_set_double(value, settings.zero_parallax_dioptre);
        return true;
    case property::DepthGain:
        g_value_set_double(value, p.depth_gain);
        return true;
    case property::InvertDepth:
        g_value_set_boolean(value, p.invert_depth);
        return true;
    case property::DepthSide:
        g_value_set_enum(value, static_cast<int>(p.depth_side));
        return true;
    case property::Fill:
        g_value_set_enum(value, p.fill);
        return true;
    default:
        return get_lens_property(settings, id, value);
    }
}

} // namespace dff
