/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthio/depth_range_properties.h"

#include <string>
#include <string_view>

namespace dff {

namespace {

constexpr double greatest = 1000.0; /* dioptres: a millimetre away */

void install(GObjectClass *object_class, guint id, const char *name, const char *nick,
             const std::string &blurb, gint mutability)
{
    const auto flags =
        static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_NAME | G_PARAM_STATIC_NICK | mutability);
    g_object_class_install_property(object_class, id,
                                    g_param_spec_double(name, nick, blurb.c_str(),
                                                        DepthRangeProperties::not_set, greatest,
                                                        DepthRangeProperties::not_set, flags));
}

/* The member that a property is for, or nullptr. */
template <typename Range> auto *member(Range &range, const GParamSpec *property)
{
    const std::string_view name = property->name;
    return name == "near" ? &range.near : name == "far" ? &range.far : nullptr;
}

} // namespace

void install_depth_range(GObjectClass *object_class, guint first, const char *otherwise, gint mutability)
{
    install(object_class, first, "near", "Near",
            std::string("Object vergence in dioptres (1 / metres) of the first colour; ") + otherwise,
            mutability);
    install(object_class, first + 1, "far", "Far",
            std::string("Object vergence in dioptres (1 / metres) of the last colour, less than near; 0 is "
                        "infinity; ") +
                otherwise,
            mutability);
}

bool set_depth_range(DepthRangeProperties &range, const GParamSpec *property, const GValue *value)
{
    double *target = member(range, property);
    if (target)
        *target = g_value_get_double(value);
    return target != nullptr;
}

bool get_depth_range(const DepthRangeProperties &range, const GParamSpec *property, GValue *value)
{
    const double *source = member(range, property);
    if (source)
        g_value_set_double(value, *source);
    return source != nullptr;
}

} // namespace dff
