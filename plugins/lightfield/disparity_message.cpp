/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "disparity_message.h"

#include <cmath>

namespace dff {

namespace {

/* To three digits, and never above. */
double rounded_down(double gain)
{
    const double digit = std::pow(10.0, std::floor(std::log10(gain)) - 2.0);
    return std::floor(gain / digit) * digit;
}

} // namespace

void add_disparity(GstStructure *structure, const LightFieldDisparity &disparity)
{
    gst_structure_set(structure, "disparity", G_TYPE_DOUBLE, disparity.outermost, "sharp-disparity",
                      G_TYPE_DOUBLE, disparity.sharp, nullptr);
}

void post_disparity(GstElement *element, const LightFieldDisparity &disparity)
{
    GstStructure *fields = gst_structure_new_empty("lightfieldcompose-disparity");
    add_disparity(fields, disparity);
    gst_element_post_message(element, gst_message_new_element(GST_OBJECT(element), fields));
    if (!disparity.is_sharp())
        GST_ELEMENT_WARNING(
            element, STREAM, FORMAT,
            ("The ends of the sweep will look blurred: between the outermost views they move by %.1f pixels, "
             "and the display shows %.1f sharply. A depth-gain of at most %.3g keeps all of the sweep sharp",
             disparity.outermost, disparity.sharp, rounded_down(disparity.sharp_gain)),
            (nullptr));
}

} // namespace dff
