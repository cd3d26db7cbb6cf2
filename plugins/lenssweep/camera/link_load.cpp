/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "link_load.h"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace dff {

namespace {

/* Bytes a packet costs beside its pixels: in the IP packet the heads of IP, UDP and GVSP, around it those of
 * Ethernet with preamble, checksum and gap. */
constexpr double heads_inside = 20 + 8 + 8;
constexpr double heads_outside = 14 + 4 + 8 + 12;

} // namespace

double paper_rate(const LinkLoad &load)
{
    return load.frame_rate * static_cast<double>(load.payload) * 8 / (1024.0 * 1024.0 * 1024.0);
}

double link_rate(const LinkLoad &load)
{
    const auto payload = static_cast<double>(load.payload);
    if (load.packet <= heads_inside)
        return load.frame_rate * payload * 8;
    const double packets = std::ceil(payload / (load.packet - heads_inside)) + 2; /* leader and trailer */
    return load.frame_rate * (payload + packets * (heads_inside + heads_outside)) * 8;
}

std::string describe(const LinkLoad &load)
{
    std::ostringstream text;
    text << std::fixed << std::setprecision(3) << load.frame_rate << " frames/s of " << load.payload
         << " bytes are " << load.frame_rate * static_cast<double>(load.payload) * 8e-9 << " Gbit/s, "
         << link_rate(load) * 1e-9 << " Gbit/s with packet heads (" << paper_rate(load)
         << " by equation (1) of the paper, in units of 1024^3)";
    return text.str();
}

std::string complaint(const LinkLoad &load)
{
    std::ostringstream text;
    text << std::fixed << std::setprecision(3);
    if (load.link_bits > 0 && link_rate(load) > load.link_bits)
        text << "The link carries " << load.link_bits * 1e-9 << " Gbit/s, but " << describe(load)
             << "; frames will be lost. Lower rate, planes, or the size of the picture. ";
    if (load.exposure_us >= load.period_us)
        text << std::setprecision(0) << "An exposure of " << load.exposure_us << " us does not fit into the "
             << load.period_us
             << " us from frame to frame; triggers will be missed. Lower exposure, planes or rate.";
    return text.str();
}

} // namespace dff
