/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depth_attributes.h"

#include <cmath>

namespace dff {

namespace {

/* With a point whatever the language, and as many digits as bring the number back exactly. */
std::string text_of(double number)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    return g_ascii_dtostr(text, sizeof text, number);
}

std::string list_of(const std::vector<double> &numbers)
{
    std::string text;
    for (const double number : numbers) {
        if (!text.empty())
            text += ' ';
        text += text_of(number);
    }
    return text;
}

std::string name_of(GstDepthUnit unit)
{
    g_autoptr(GEnumClass) units = G_ENUM_CLASS(g_type_class_ref(GST_TYPE_DEPTH_UNIT));
    return g_enum_get_value(units, unit)->value_nick;
}

} // namespace

std::vector<std::pair<std::string, std::string>> depth_attributes(const GstDepthInfo &info)
{
    std::vector<std::pair<std::string, std::string>> attributes = {
        {"depth-unit", name_of(info.unit)},
        {"depth-scale", text_of(info.scale)},
        {"depth-offset", text_of(info.offset)},
    };
    if (!std::isnan(info.near) && !std::isnan(info.far)) {
        attributes.emplace_back("depth-near", text_of(info.near));
        attributes.emplace_back("depth-far", text_of(info.far));
    }
    if (info.has_intrinsics) {
        std::vector<double> numbers = {info.fx, info.fy, info.cx, info.cy};
        numbers.insert(numbers.end(), std::begin(info.distortion), std::end(info.distortion));
        attributes.emplace_back("depth-intrinsics", list_of(numbers));
    }
    return attributes;
}

} // namespace dff
