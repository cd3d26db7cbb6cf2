/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "fpga_lens.h"

#include "i2c_retry.h"

#include <array>
#include <utility>

namespace dff {

namespace {

using namespace sweep_registers;

/* An SMBus block of words from command k on is command 128 + k */
constexpr std::uint8_t block_flag = 0x80;

} // namespace

FpgaLens::FpgaLens(I2cBus &bus) : bus_(bus)
{
    if (read(Word::identity) != identity_default) {
        throw I2cError("the device at this address is not the sweep sequencer of fpga/");
    }
    const auto version = read(Word::version);
    if (version_major.get(version) != version_major.get(version_default)) {
        throw I2cError("the sweep sequencer has register map " + std::to_string(version_major.get(version)) +
                       ", this driver knows " + std::to_string(version_major.get(version_default)));
    }
    knows_direct_ = version_minor.get(version) >= 1;
    timing_ = {std::chrono::microseconds{read(Word::lens_gap_us)},
               std::chrono::microseconds{read(Word::lens_stage_us)}};
}

FpgaLens::~FpgaLens()
{
    stop_quietly();
}

template <typename Transfer> auto FpgaLens::retry(Transfer transfer)
{
    return with_retries(transfer, [this] { stop_quietly(); });
}

void FpgaLens::stop_quietly() noexcept
{
    try_quietly([this] { bus_.write_word(static_cast<std::uint8_t>(Word::control), 0); });
}

std::uint16_t FpgaLens::read(Word word)
{
    return retry([&] { return bus_.read_word(static_cast<std::uint8_t>(word)); });
}

void FpgaLens::write(Word word, std::uint16_t value)
{
    retry([&] { bus_.write_word(static_cast<std::uint8_t>(word), value); });
}

void FpgaLens::write(const RegisterWrite &write)
{
    std::vector<std::uint8_t> bytes;
    for (const auto value : write.values) {
        bytes.push_back(static_cast<std::uint8_t>(value & 0xff));
        bytes.push_back(static_cast<std::uint8_t>(value >> 8));
    }
    retry([&] {
        bus_.write_block(static_cast<std::uint8_t>(block_flag | static_cast<unsigned>(write.word)), bytes);
    });
}

void FpgaLens::load(const SweepTable &table)
{
    check(table, timing_);
    if (table.driver->direct() && !knows_direct_) {
        throw I2cError("the sweep sequencer has register map 1.0, and a " + std::string(table.driver->name) +
                       " needs 1.1: load a newer bitstream");
    }
    for (const auto &block : register_writes(table)) {
        write(block);
    }
    write(Word::commit, commit_commit.mask());
    const auto refused =
        static_cast<std::uint16_t>(read(Word::error) & (error_table_planes.mask() |
                                                        error_table_timing.mask() | error_table_code.mask()));
    if (refused != 0) {
        throw I2cError("the sweep sequencer refused the table: " + describe_errors(refused));
    }
}

void FpgaLens::start(bool gated)
{
    write(Word::error, 0xffff);
    write(Word::control, static_cast<std::uint16_t>(control_enable.mask() | control_gated.place(gated)));
}

void FpgaLens::stop()
{
    write(Word::control, 0);
}

FpgaLensStatus FpgaLens::status()
{
    const auto word = read(Word::status);
    FpgaLensStatus status;
    status.busy = status_busy.get(word) != 0;
    status.table_valid = status_table_valid.get(word) != 0;
    status.commit_pending = status_commit_pending.get(word) != 0;
    status.downward = status_downward.get(word) != 0;
    status.plane = status_plane.get(word);
    status.errors = status_failed.get(word) != 0 ? read(Word::error) : std::uint16_t{0};
    return status;
}

std::uint32_t FpgaLens::read_counter(Word low, Word high)
{
    /* Reading the low word latches the high one */
    const auto both = [&] {
        const std::uint32_t low_word = bus_.read_word(static_cast<std::uint8_t>(low));
        return static_cast<std::uint32_t>(bus_.read_word(static_cast<std::uint8_t>(high))) << 16 | low_word;
    };
    return with_retries(both, [] {});
}

std::uint32_t FpgaLens::sweep_count()
{
    return read_counter(Word::sweep_count_low, Word::sweep_count_high);
}

std::uint32_t FpgaLens::frame_count()
{
    return read_counter(Word::frame_count_low, Word::frame_count_high);
}

std::string describe_errors(std::uint16_t errors)
{
    static constexpr std::array<std::pair<Field, const char *>, 8> meanings{{
        {error_lens_nack, "the lens driver does not answer: check its supply and address"},
        {error_lens_stretch, "the clock of the lens bus is held low"},
        {error_lens_stuck, "the data line of the lens bus is held low"},
        {error_lens_arbitration, "something else drives the lens bus"},
        {error_late, "the lens was not in place in time, and the trigger was not given"},
        {error_table_planes, "the number of planes is not 2 to 64"},
        {error_table_timing, "the times of the table cannot be met"},
        {error_table_code, "a code of the lens is above 1023"},
    }};
    std::string text;
    for (const auto &[field, meaning] : meanings) {
        if (field.get(errors) != 0) {
            text += (text.empty() ? "" : "; ") + std::string(meaning);
        }
    }
    return text;
}

} // namespace dff
