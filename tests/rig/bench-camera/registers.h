/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>

namespace dff {

/* Where genicam.xml keeps what is not ArvFakeCamera's own. 32 bits each, big endian; rates, times, decibels
 * and dioptres are IEEE floats. */
enum Register : uint32_t {
    register_frame_rate_enable = 0xa000,
    register_frame_rate = 0xa004, /* Hz */
    register_exposure_mode = 0xa008,
    register_exposure_time = 0xa00c, /* microseconds */
    register_trigger_mode = 0xa010,
    register_trigger_source = 0xa014,
    register_trigger_activation = 0xa018,
    register_trigger_overlap = 0xa01c,
    register_trigger_software = 0xa020,
    register_gain = 0xa028,             /* dB */
    register_optic_initialize = 0xa02c, /* 1 once it is */
    register_focal_power = 0xa034,      /* dioptres, as the client wants it */
    register_settled_power = 0xa038,    /* as the lens has it */
};

/* Bootstrap registers of GigE Vision that a camera names itself in. */
constexpr uint32_t register_vendor = 0x48;
constexpr uint32_t register_model = 0x68;
constexpr uint32_t register_version = 0x88;
constexpr uint32_t name_length = 32;

enum TriggerSource : uint32_t { source_line0 = 0, source_line1 = 1, source_software = 2 };

} // namespace dff
