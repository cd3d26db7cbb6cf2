/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 * Made by fpga/generate.py from fpga/registers.toml; do not edit. */
/* clang-format off */
#pragma once

#include <cstdint>

namespace dff::sweep_registers {

/* Bits of a word: `width` bits from bit `shift` up. */
struct Field {
    unsigned shift;
    unsigned width;

    constexpr std::uint16_t mask() const { return static_cast<std::uint16_t>(((1u << width) - 1u) << shift); }
    constexpr std::uint16_t get(std::uint16_t word) const { return static_cast<std::uint16_t>((word & mask()) >> shift); }
    constexpr std::uint16_t place(unsigned value) const { return static_cast<std::uint16_t>((value << shift) & mask()); }
};

/* Number of a word; it is the SMBus command as well. */
enum class Word : std::uint8_t {
    /* Always 0xDFF5: this is a sweep sequencer. */
    identity = 0,
    /* Version of this register map. A driver accepts any minor version of the major version it knows. */
    version = 1,
    /* Starts and stops the sweep. Takes effect at once, without `commit`. */
    control = 2,
    /* What the sequencer does now. */
    status = 3,
    /* What stopped the sweep. The bits are sticky; while one is set no trigger is given. Write 1 to a bit to clear it. */
    error = 4,
    /* The plane at which the first of the errors now set came up. */
    error_plane = 5,
    /* Low word of the sweeps begun since reset: one for each `sync` pulse. Reading it latches the high word. */
    sweep_count_low = 6,
    /* High word of the sweeps begun, as it was when the low word was read. */
    sweep_count_high = 7,
    /* Low word of the triggers given since reset. Reading it latches the high word. */
    frame_count_low = 8,
    /* High word of the triggers given, as it was when the low word was read. */
    frame_count_high = 9,
    /* Time that the code writes between two exposures take in this build: four byte writes, rounded up. */
    lens_gap_us = 10,
    /* Time that staging the next plane's code A takes during an exposure: two byte writes, rounded up. */
    lens_stage_us = 11,
    /* Checks the staged words and the table and, if they can be met, puts them in use when the sweep ends. */
    commit = 12,
    /* Number of planes of a sweep. Staged. */
    planes = 13,
    /* Shape of the sweep and of the trigger. Staged. */
    shape = 14,
    /* Time from one exposure to the next. Staged. */
    period_us = 15,
    /* Time after a trigger during which the lens is left alone. Staged. */
    exposure_us = 16,
    /* Extra time before the first plane of each sawtooth sweep, and of the first sweep after a start. Staged. */
    flyback_us = 17,
    /* Length of the trigger pulse behind the opto-isolator, and of the `sync` pulse. Staged. */
    trigger_width_us = 18,
    /* Delay of the opto-isolator from the pin's rising edge to the camera. Staged. */
    opto_on_us = 19,
    /* Delay of the opto-isolator from the pin's falling edge to the camera. Staged. */
    opto_off_us = 20,
    /* I2C address of the lens driver, and how it takes a code. Staged. */
    lens_address = 21,
    /* Byte write that wakes the lens driver, sent when a sweep starts from standstill (MAX14574: USERMODE = active). Staged. */
    lens_start = 22,
    /* Registers that take a code (MAX14574: OIS_LSB and LLV4). Staged. */
    lens_stage = 23,
    /* Byte write that moves the lens to the code (MAX14574: CMND = UPD_OUT); not sent with `lens_address.direct`. Staged. */
    lens_commit = 24,
    /* The plane that the four words below belong to. Takes effect at once, without `commit`. */
    plane_select = 25,
    /* First code of the plane (overdrive). Staged, in the window of `plane_select`. */
    plane_code_a = 26,
    /* Time from code A to the staging of code B. Staged, in the window of `plane_select`. */
    plane_delay_us = 27,
    /* Second code of the plane (hold). Staged, in the window of `plane_select`. */
    plane_code_b = 28,
    /* Time that the lens is given from code B to the trigger, at least. Staged, in the window of `plane_select`. */
    plane_settle_us = 29,
};

inline constexpr unsigned word_count = 30;

/* The identity. */
inline constexpr Field identity_value {0, 16};
/* Grows when words or bits are added. */
inline constexpr Field version_minor {0, 8};
/* Grows when the meaning of a word changes. */
inline constexpr Field version_major {8, 8};
/* 1: sweep, as long as there is a valid table and no error. 0: finish the exposure that has begun, then stop. */
inline constexpr Field control_enable {0, 1};
/* 1: sweep only while the `run` input is high. 0: run free. */
inline constexpr Field control_gated {1, 1};
/* The sequencer is working: a sweep, or the exposure that ends it. */
inline constexpr Field status_busy {0, 1};
/* A table has been committed since reset, and is in use. */
inline constexpr Field status_table_valid {1, 1};
/* A committed table waits for the end of the sweep. */
inline constexpr Field status_commit_pending {2, 1};
/* The plane in hand belongs to a downward sweep of a triangle (from the last plane to plane 0). */
inline constexpr Field status_downward {3, 1};
/* Level of the `run` input. */
inline constexpr Field status_run {4, 1};
/* A bit of `error` is set, and the sweep stands still. */
inline constexpr Field status_failed {5, 1};
/* The plane in hand. */
inline constexpr Field status_plane {6, 6};
/* The lens driver did not acknowledge a byte. */
inline constexpr Field error_lens_nack {0, 1};
/* The lens bus clock was held low for longer than the limit (100 us). */
inline constexpr Field error_lens_stretch {1, 1};
/* The lens bus data line was low, and nine clocks did not free it. */
inline constexpr Field error_lens_stuck {2, 1};
/* Something else drove the lens bus during a transfer. */
inline constexpr Field error_lens_arbitration {3, 1};
/* A code was not in place, or had not settled, when the trigger was due. The trigger was not given. */
inline constexpr Field error_late {4, 1};
/* Commit refused: `planes` is not in 2..64. */
inline constexpr Field error_table_planes {5, 1};
/* Commit refused: the times cannot be met (see the rules below). */
inline constexpr Field error_table_timing {6, 1};
/* Commit refused: a code of the lens is above 1023. */
inline constexpr Field error_table_code {7, 1};
/* Plane of the sweep, or of the table if the commit was refused. */
inline constexpr Field error_plane_plane {0, 6};
/* Bits 15..0. */
inline constexpr Field sweep_count_low_value {0, 16};
/* Bits 31..16. */
inline constexpr Field sweep_count_high_value {0, 16};
/* Bits 15..0. */
inline constexpr Field frame_count_low_value {0, 16};
/* Bits 31..16. */
inline constexpr Field frame_count_high_value {0, 16};
/* Microseconds; 291 with a 125 MHz clock and a 400 kHz lens bus. */
inline constexpr Field lens_gap_us_value {0, 16};
/* Microseconds; 146 with a 125 MHz clock and a 400 kHz lens bus. */
inline constexpr Field lens_stage_us_value {0, 16};
/* Write 1 to commit. */
inline constexpr Field commit_commit {0, 1};
/* 2..64; plane 0 is the nearest. */
inline constexpr Field planes_value {0, 16};
/* 0: sawtooth, plane 0 up to the last one and back at once. 1: triangle, every other sweep runs downward. */
inline constexpr Field shape_triangle {0, 1};
/* 1: the trigger pin rests high and pulses low. A change waits until the sweep stands still. */
inline constexpr Field shape_trigger_active_low {1, 1};
/* Microseconds. */
inline constexpr Field period_us_value {0, 16};
/* Microseconds; at least `lens_stage_us`. */
inline constexpr Field exposure_us_value {0, 16};
/* Microseconds. */
inline constexpr Field flyback_us_value {0, 16};
/* Microseconds; 1..`exposure_us`. */
inline constexpr Field trigger_width_us_value {0, 16};
/* Microseconds. */
inline constexpr Field opto_on_us_value {0, 8};
/* Microseconds. */
inline constexpr Field opto_off_us_value {0, 8};
/* 7 bits, without the read/write bit. */
inline constexpr Field lens_address_value {0, 7};
/* 0: a code is staged in two registers and the lens moved by a third write (MAX14574). 1: one write to `lens_stage.high_register` of bits 9..2 of the code moves the lens (MAX14515). */
inline constexpr Field lens_address_direct {7, 1};
/* Register number. */
inline constexpr Field lens_start_register {0, 8};
/* Value written. */
inline constexpr Field lens_start_value {8, 8};
/* Takes bits 1..0 of the code in its bits 7..6; not written with `lens_address.direct`. */
inline constexpr Field lens_stage_low_register {0, 8};
/* Takes bits 9..2 of the code. */
inline constexpr Field lens_stage_high_register {8, 8};
/* Register number. */
inline constexpr Field lens_commit_register {0, 8};
/* Value written. */
inline constexpr Field lens_commit_value {8, 8};
/* 0..63. */
inline constexpr Field plane_select_plane {0, 6};
/* 0..1023. */
inline constexpr Field plane_code_a_value {0, 16};
/* Microseconds. */
inline constexpr Field plane_delay_us_value {0, 16};
/* 0..1023. */
inline constexpr Field plane_code_b_value {0, 16};
/* Microseconds. */
inline constexpr Field plane_settle_us_value {0, 16};

/* Words that have another value than 0 after reset. */
inline constexpr std::uint16_t identity_default = 0xdff5;
inline constexpr std::uint16_t version_default = 0x0101;
inline constexpr std::uint16_t planes_default = 0x0006;
inline constexpr std::uint16_t period_us_default = 0x1900;
inline constexpr std::uint16_t exposure_us_default = 0x1770;
inline constexpr std::uint16_t trigger_width_us_default = 0x0064;
inline constexpr std::uint16_t lens_address_default = 0x0077;
inline constexpr std::uint16_t lens_start_default = 0x0303;
inline constexpr std::uint16_t lens_stage_default = 0x0804;
inline constexpr std::uint16_t lens_commit_default = 0x0209;

} // namespace dff::sweep_registers
