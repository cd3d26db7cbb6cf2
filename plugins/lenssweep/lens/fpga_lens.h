/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "i2c_bus.h"
#include "sweep_table.h"

#include <cstdint>
#include <string>

namespace dff {

/* What the sequencer says of itself. */
struct FpgaLensStatus {
    bool busy = false;
    bool table_valid = false;
    bool commit_pending = false;
    bool downward = false;
    unsigned plane = 0;
    std::uint16_t errors = 0; /* word `error`; 0 if the sweep may run */
};

/* The sweep sequencer in the FPGA, behind its I2C slave.
 *
 * A transfer that fails is tried again a few times. If that does not help, the sequencer is told to stop (as
 * far as it still hears) and I2cError is thrown; the trigger then comes to rest after the exposure in hand.
 */
class FpgaLens {
public:
    /* Checks identity and version; throws I2cError for a slave that is something else. The bus outlives this
     * object. */
    explicit FpgaLens(I2cBus &bus);

    /* Stops the sweep. */
    ~FpgaLens();
    FpgaLens(const FpgaLens &) = delete;
    FpgaLens &operator=(const FpgaLens &) = delete;

    /* Times of the code writes in this build. */
    LensTiming timing() const { return timing_; }

    /* Puts a table in use: at once, or when the sweep that runs ends. Before anything is written it throws
     * std::invalid_argument for a table that cannot be met, and I2cError for a driver that this build of the
     * sequencer does not know. */
    void load(const SweepTable &table);

    /* Starts the sweep with plane 0, after clearing old errors; gated: only while the run line is high. */
    void start(bool gated);

    /* The exposure in hand is finished, then the trigger rests. */
    void stop();

    FpgaLensStatus status();

    /* Sweeps begun since the sequencer's reset: one for each sync pulse. A count that cannot be read does not
     * stop the sweep. */
    std::uint32_t sweep_count();

    /* Triggers given since the sequencer's reset. */
    std::uint32_t frame_count();

private:
    using Word = sweep_registers::Word;

    std::uint16_t read(Word word);
    void write(Word word, std::uint16_t value);
    void write(const RegisterWrite &write);
    std::uint32_t read_counter(Word low, Word high);
    template <typename Transfer> auto retry(Transfer transfer);
    void stop_quietly() noexcept;

    I2cBus &bus_;
    LensTiming timing_{};
    bool knows_direct_ = false; /* `lens_address.direct` is of register map 1.1 */
};

/* What the bits of the word `error` mean, for a message to the user; empty for 0. */
std::string describe_errors(std::uint16_t errors);

} // namespace dff
