/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "sweep_properties.h"

#include "common/checked_properties.h"

#include <gst/gst.h>
#include <stdexcept>

namespace {

constexpr auto flags =
    static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY);

/* Dioptres: what lies beyond has no lens. */
constexpr gdouble least_power = -100.0;
constexpr gdouble greatest_power = 1000.0;

} // namespace

std::vector<gdouble> numbers_of(const GValue *array)
{
    std::vector<gdouble> result;
    for (guint i = 0; i < gst_value_array_get_size(array); i++)
        result.push_back(g_value_get_double(gst_value_array_get_value(array, i)));
    return result;
}

void put_numbers(GValue *array, const std::vector<gdouble> &numbers)
{
    for (const gdouble number : numbers) {
        g_auto(GValue) item = G_VALUE_INIT;
        g_value_init(&item, G_TYPE_DOUBLE);
        g_value_set_double(&item, number);
        gst_value_array_append_value(array, &item);
    }
}

dff::SweepPlan SweepProperties::plan() const
{
    for (const gdouble power : {near, far})
        if (!(power >= least_power && power <= greatest_power))
            throw std::invalid_argument("near and far are in dioptres, from -100 to 1000");
    return powers.empty() ? dff::SweepPlan::even(planes, near, far) : dff::SweepPlan::at(powers);
}

void install_sweep_properties(GObjectClass *klass, const SweepProperties &defaults)
{
    const bool unknown = !defaults.has_powers();
    g_object_class_install_property(klass, PROP_PLANES,
                                    dff::checked_at_start(g_param_spec_uint(
                                        "planes", "Planes", "Planes a sweep", dff::SweepPlan::min_planes,
                                        dff::SweepPlan::max_planes, defaults.planes, flags)));
    g_object_class_install_property(
        klass, PROP_NEAR,
        dff::checked_at_start(g_param_spec_double(
            "near", "Near",
            unknown ? "Object vergence of plane 0, the nearest, in dioptres (1 / metres); equal to far: not "
                      "known, unless a lens that knows its powers is moved here, from 5 to 0 then"
                    : "Object vergence of plane 0, the nearest, in dioptres (1 / metres)",
            least_power, greatest_power, defaults.near, flags)));
    g_object_class_install_property(
        klass, PROP_FAR,
        dff::checked_at_start(g_param_spec_double(
            "far", "Far",
            unknown ? "Object vergence of the last plane in dioptres, less than near; 0 is infinity; equal "
                      "to near: "
                      "not known"
                    : "Object vergence of the last plane in dioptres, less than near; 0 is infinity",
            least_power, greatest_power, defaults.far, flags)));
    g_object_class_install_property(
        klass, PROP_POWERS,
        gst_param_spec_array(
            "powers", "Powers",
            "Object vergence of each plane in dioptres, falling; replaces planes, near and far unless empty",
            g_param_spec_double("power", "Power", "Object vergence in dioptres", least_power, greatest_power,
                                0.0, flags),
            flags));
}

bool set_sweep_property(SweepProperties &properties, guint id, const GValue *value)
{
    switch (id) {
    case PROP_PLANES:
        properties.planes = g_value_get_uint(value);
        return true;
    case PROP_NEAR:
        properties.near = g_value_get_double(value);
        return true;
    case PROP_FAR:
        properties.far = g_value_get_double(value);
        return true;
    case PROP_POWERS:
        properties.powers = numbers_of(value);
        return true;
    default:
        return false;
    }
}

bool get_sweep_property(const SweepProperties &properties, guint id, GValue *value)
{
    switch (id) {
    case PROP_PLANES:
        g_value_set_uint(value, properties.planes);
        return true;
    case PROP_NEAR:
        g_value_set_double(value, properties.near);
        return true;
    case PROP_FAR:
        g_value_set_double(value, properties.far);
        return true;
    case PROP_POWERS:
        put_numbers(value, properties.powers);
        return true;
    default:
        return false;
    }
}
