/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "property_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace dff::walk {

namespace {

/* Texts that mean something to somebody; all others get those of the empty name. */
const std::map<std::string, std::vector<const char *>> texts = {
    {"", {nullptr, "", "nobody knows", "/nonexistent/file"}},
    {"camera", {nullptr, "Fake_1", "Fake_1", "Fake_1", "nobody"}},
    {"lens",
     {"none", "none", "fpga:/nonexistent@0x3c", "max14574:/nonexistent@0x77", "genicam:FocalPower",
      "optotune:/nonexistent", "element:nobody.focus", "wrong"}},
    {"noise", {"none", "mild", "moderate", "strong", "1,5", "nan,inf", "x"}},
    {"source",
     {"lenssweeptestsrc ! video/x-raw,width=64,height=64", "videotestsrc ! video/x-raw,width=64,height=64",
      "lenssweeptestsrc ! video/x-raw,width=64,height=64 ! focalstackmux", "fakesink", "wrong ! ! words"}},
};

template <typename T> T some_number(Chance &chance, T least, T most, T fallback)
{
    switch (chance.below(4)) {
    case 0:
        return least;
    case 1:
        return most;
    case 2:
        return fallback;
    default:
        /* Near the default, where most users are. */
        return std::clamp(static_cast<T>(fallback + static_cast<T>(chance.below(7))), least, most);
    }
}

double some_double(Chance &chance, double least, double most, double fallback)
{
    if (chance.percent(75))
        return some_number<double>(chance, least, most, fallback);
    return std::clamp(fallback * 0.5 + static_cast<double>(chance.below(1000)) / 100, least, most);
}

bool is_of_gstreamer(GType type)
{
    static const char *const names[] = {
        "GObject",        "GstObject",       "GstElement",           "GstBin",
        "GstBaseSrc",     "GstPushSrc",      "GstAggregator",        "GstBaseTransform",
        "GstVideoFilter", "GstVideoEncoder", "GstRTPHeaderExtension"};
    return std::any_of(std::begin(names), std::end(names),
                       [&](const char *name) { return g_str_equal(name, g_type_name(type)); });
}

bool set_array(GValue *value, const GParamSpec *property, Chance &chance)
{
    const GParamSpec *item = GST_PARAM_SPEC_ARRAY_LIST(property)->element_spec;
    if (!item || item->value_type != G_TYPE_DOUBLE)
        return false;
    const auto count = chance.of<unsigned>({0, 1, 2, 5, 65});
    for (unsigned i = 0; i < count; i++) {
        g_auto(GValue) number = G_VALUE_INIT;
        g_value_init(&number, G_TYPE_DOUBLE);
        g_value_set_double(&number,
                           chance.percent(5) ? chance.of<double>({NAN, INFINITY, -1e300}) : 5.0 - i * 0.5);
        gst_value_array_append_value(value, &number);
    }
    return true;
}

#define SET_NUMBER(TYPE, Spec, set)                                                                          \
    if (G_IS_PARAM_SPEC_##TYPE(property)) {                                                                  \
        const auto *spec = G_PARAM_SPEC_##TYPE(property);                                                    \
        set(value, some_number(chance, spec->minimum, spec->maximum, spec->default_value));                  \
        return true;                                                                                         \
    }

bool fill(GValue *value, GParamSpec *property, Chance &chance)
{
    SET_NUMBER(INT, GParamSpecInt, g_value_set_int)
    SET_NUMBER(UINT, GParamSpecUInt, g_value_set_uint)
    SET_NUMBER(INT64, GParamSpecInt64, g_value_set_int64)
    SET_NUMBER(UINT64, GParamSpecUInt64, g_value_set_uint64)
    if (G_IS_PARAM_SPEC_DOUBLE(property)) {
        const auto *spec = G_PARAM_SPEC_DOUBLE(property);
        g_value_set_double(value, some_double(chance, spec->minimum, spec->maximum, spec->default_value));
        return true;
    }
    if (G_IS_PARAM_SPEC_FLOAT(property)) {
        const auto *spec = G_PARAM_SPEC_FLOAT(property);
        g_value_set_float(value, static_cast<float>(
                                     some_double(chance, spec->minimum, spec->maximum, spec->default_value)));
        return true;
    }
    if (G_IS_PARAM_SPEC_BOOLEAN(property)) {
        g_value_set_boolean(value, chance.percent(50));
        return true;
    }
    if (G_IS_PARAM_SPEC_ENUM(property)) {
        const GEnumClass *values = G_PARAM_SPEC_ENUM(property)->enum_class;
        g_value_set_enum(value, values->values[chance.below(values->n_values)].value);
        return true;
    }
    if (G_IS_PARAM_SPEC_STRING(property)) {
        const auto found = texts.find(property->name);
        const auto &candidates = found == texts.end() ? texts.at("") : found->second;
        g_value_set_static_string(value, candidates[chance.below(candidates.size())]);
        return true;
    }
    if (GST_IS_PARAM_SPEC_ARRAY_LIST(property))
        return set_array(value, property, chance);
    return false;
}

} // namespace

std::vector<GParamSpec *> own_properties(GstElement *element)
{
    guint count = 0;
    g_autofree GParamSpec **all = g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count);
    std::vector<GParamSpec *> own(all, all + count);
    std::erase_if(own, [](const GParamSpec *property) { return is_of_gstreamer(property->owner_type); });
    return own;
}

bool may_be_set(const GParamSpec *property, GstState state)
{
    if ((property->flags & G_PARAM_WRITABLE) == 0 || (property->flags & G_PARAM_CONSTRUCT_ONLY) != 0)
        return false;
    if ((property->flags & GST_PARAM_MUTABLE_PLAYING) != 0)
        return true;
    if ((property->flags & GST_PARAM_MUTABLE_PAUSED) != 0)
        return state <= GST_STATE_PAUSED;
    return state <= GST_STATE_READY;
}

std::string set_some_value(GstElement *element, GParamSpec *property, Chance &chance)
{
    g_auto(GValue) value = G_VALUE_INIT;
    g_value_init(&value, property->value_type);
    if (!fill(&value, property, chance))
        return "";
    g_object_set_property(G_OBJECT(element), property->name, &value);
    g_autofree gchar *text = g_strdup_value_contents(&value);
    return std::string(property->name) + "=" + text;
}

} // namespace dff::walk
