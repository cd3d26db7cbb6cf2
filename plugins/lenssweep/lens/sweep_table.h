/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "lens_driver.h"
#include "sweep_registers.h"

#include <chrono>
#include <cstdint>
#include <vector>

namespace dff {

/* What the lens is told for one plane: an overdrive, and what is held. */
struct PlaneStep {
    double overdrive = 0;               /* code A, as the driver is told: V rms, or its code */
    std::chrono::microseconds delay{};  /* from code A to the staging of code B */
    double hold = 0;                    /* code B */
    std::chrono::microseconds settle{}; /* from code B to the exposure, at least */
};

/* A sweep in physical units, nearest plane first. */
struct SweepTable {
    const LensDriver *driver = &max14574_driver;
    std::vector<PlaneStep> planes;
    std::chrono::microseconds period{6400};
    std::chrono::microseconds exposure{6000};
    std::chrono::microseconds flyback{};
    std::chrono::microseconds trigger_width{100};
    std::chrono::microseconds opto_on{};  /* delay of the opto-isolator after the pin's rising edge */
    std::chrono::microseconds opto_off{}; /* ... and after its falling edge */
    bool triangle = false;
    bool trigger_active_low = false;
};

/* Times that the code writes take in the build of the sequencer, as it tells. */
struct LensTiming {
    std::chrono::microseconds gap;   /* between two exposures */
    std::chrono::microseconds stage; /* during an exposure */
};

/* Words written one after the other from `word` on. */
struct RegisterWrite {
    sweep_registers::Word word;
    std::vector<std::uint16_t> values;
};

/* Throws std::invalid_argument, with the rule in its text, for a table that the sequencer would refuse. */
void check(const SweepTable &table, const LensTiming &timing);

/* The writes that stage the table, without the commit. The table has passed check(). */
std::vector<RegisterWrite> register_writes(const SweepTable &table);

} // namespace dff
