/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <string>

namespace dff {

/* What a camera has to send, and over what. */
struct LinkLoad {
    double frame_rate = 0;     /* frames a second */
    std::uint64_t payload = 0; /* bytes a frame */
    double exposure_us = 0;
    double period_us = 0; /* from one exposure to the next */
    double link_bits = 0; /* bits a second that the link carries; 0: not known */
    unsigned packet = 0;  /* bytes of an IP packet of GigE Vision; 0: no such packets */
};

/* Equation (1) of Oliva-García 2022, F W H C 8 / 1024^3, in its unit. */
double paper_rate(const LinkLoad &load);

/* Bits a second on the link, packets' heads included. */
double link_rate(const LinkLoad &load);

/* What cannot work, with the figures, for the user; empty if nothing. */
std::string complaint(const LinkLoad &load);

/* The figures. */
std::string describe(const LinkLoad &load);

} // namespace dff
