/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lens/found_lenses.h"
#include "lens/fpga_lens.h"
#include "lens/linux_i2c_bus.h"
#include "lens/open_lens.h"
#include "lens/sweep_registers.h"
#include "rig.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

using namespace std::chrono_literals;
using dff::sweep_registers::Word;

namespace {

using Log = std::vector<std::string>;

uint8_t number(Word word)
{
    return static_cast<uint8_t>(word);
}

std::unique_ptr<dff::Lens> open(const std::string &uri, const std::string &profile = "")
{
    auto lens = dff::open_lens(dff::LensUri::parse(uri), {profile});
    rig::empty_i2c_log();
    return lens;
}

/* What v4l2-ctl says of them. */
std::string controls_of(const std::string &device, const std::string &names)
{
    FILE *tool = popen(("v4l2-ctl -d " + device + " -C " + names).c_str(), "r");
    std::string text;
    for (int c = fgetc(tool); c != EOF; c = fgetc(tool))
        text += static_cast<char>(c);
    pclose(tool);
    return text;
}

} // namespace

TEST(Sequencer, table_is_written_and_reads_back)
{
    const auto lens = open("fpga:" + rig::i2c_bus());
    lens->prepare({dff::SweepPlan::even(6, 5.0, 0.0), 6400us, 6000us, true});

    dff::LinuxI2cBus bus(rig::i2c_bus(), 0x3c);
    EXPECT_EQ(bus.read_word(number(Word::planes)), 6);
    EXPECT_EQ(bus.read_word(number(Word::period_us)), 6400);
    EXPECT_EQ(bus.read_word(number(Word::exposure_us)), 6000);
    for (unsigned plane = 0; plane < 6; ++plane) {
        bus.write_word(number(Word::plane_select), static_cast<uint16_t>(plane));
        EXPECT_EQ(bus.read_word(number(Word::plane_code_b)), lens->code(plane));
        EXPECT_EQ(bus.read_word(number(Word::plane_settle_us)), 109);
    }
    const Log log = rig::i2c_log();
    EXPECT_NE(std::find(log.begin(), log.end(), "3c 0c=0001"), log.end()) << "not committed";
    EXPECT_GT(lens->code(0), lens->code(5));
}

TEST(Sequencer, profile_says_which_driver_is_on_its_bus)
{
    const std::string profile = "/tmp/max14515.yaml";
    std::ofstream(profile)
        << "%YAML:1.0\n---\nlens: test\nnominal: 1\npower_at_infinity: 0\nlens_power: [ 0, 10 ]\n"
           "driver: MAX14515\ncodes: [ 40, 200 ]\nsettle_us: 100\n";
    const auto in_codes = open("fpga:" + rig::i2c_bus(), profile);
    in_codes->prepare({dff::SweepPlan::even(3, 10.0, 0.0), 6400us, 6000us, true});

    dff::LinuxI2cBus bus(rig::i2c_bus(), 0x3c);
    EXPECT_EQ(bus.read_word(number(Word::lens_address)),
              0x76 | dff::sweep_registers::lens_address_direct.mask());
    bus.write_word(number(Word::plane_select), 1);
    EXPECT_EQ(bus.read_word(number(Word::plane_code_b)), 4 * 120); /* the middle of 40 and 200 */
    EXPECT_EQ(in_codes->code(1), 120);

    const auto in_volts = open("fpga:" + rig::i2c_bus());
    in_volts->prepare({dff::SweepPlan::even(3, 10.0, 0.0), 6400us, 6000us, true});
    EXPECT_EQ(bus.read_word(number(Word::lens_address)), dff::sweep_registers::lens_address_default);
}

TEST(Sequencer, is_started_behind_its_run_line_and_stopped_when_it_is_let_go)
{
    {
        const auto lens = open("fpga:" + rig::i2c_bus() + "@0x3c");
        lens->prepare({dff::SweepPlan::even(6, 5.0, 0.0), 6400us, 6000us, true});
        rig::empty_i2c_log();
        lens->start();
        dynamic_cast<dff::SequencedLens &>(*lens).check();
    }
    EXPECT_EQ(rig::i2c_log(), (Log{"3c 04=ffff", "3c 02=0003", "3c 02=0000"}));
}

TEST(Sequencer, another_slave_is_refused)
{
    EXPECT_THROW(open("fpga:" + rig::i2c_bus() + "@0x20"), dff::LensError);
}

TEST(LensDriver, codes_of_a_sweep_are_committed_in_order)
{
    const auto lens = open("max14574:" + rig::i2c_bus());
    auto &stepped = dynamic_cast<dff::SteppedLens &>(*lens);
    lens->prepare({dff::SweepPlan::even(6, 5.0, 0.0)});
    lens->start();
    std::vector<int> expected;
    for (int sweep = 0; sweep < 2; ++sweep) {
        for (unsigned plane = 0; plane < 6; ++plane) {
            stepped.move_to(plane);
            EXPECT_TRUE(stepped.wait_settled({}));
            expected.push_back(lens->code(plane));
        }
    }
    EXPECT_EQ(rig::committed_codes(), expected);
    EXPECT_TRUE(std::is_sorted(expected.begin(), expected.begin() + 6, std::greater<>()));
    lens->stop();
    EXPECT_EQ(rig::i2c_log().back(), "77 03=00");
}

TEST(LensDriver, transfers_that_fail_twice_are_tried_again)
{
    const auto lens = open("max14574:" + rig::i2c_bus());
    lens->prepare({dff::SweepPlan::even(2, 5.0, 0.0)});
    lens->start();
    rig::fail_i2c_transfers(2);
    dynamic_cast<dff::SteppedLens &>(*lens).move_to(1);
    EXPECT_EQ(rig::committed_codes(), (std::vector<int>{lens->code(1)}));
}

TEST(LensDriver, transfers_that_keep_failing_end_in_an_error_and_a_lens_asleep)
{
    const auto lens = open("max14574:" + rig::i2c_bus());
    lens->prepare({dff::SweepPlan::even(2, 5.0, 0.0)});
    lens->start();
    rig::fail_i2c_transfers(3);
    EXPECT_THROW(dynamic_cast<dff::SteppedLens &>(*lens).move_to(1), dff::LensError);
    EXPECT_EQ(rig::committed_codes(), std::vector<int>{});
    EXPECT_EQ(rig::i2c_log().back(), "77 03=00");
}

TEST(VideoLens, is_moved_over_its_range_after_autofocus_is_switched_off_and_gives_it_back)
{
    const auto autofocus = [] {
        return controls_of("/dev/video0", "focus_automatic_continuous,focus_absolute");
    };
    EXPECT_NE(autofocus().find("continuous: 1"), std::string::npos) << autofocus();
    {
        const auto lens = dff::open_lens(dff::LensUri::parse("v4l2:/dev/video0"), {});
        lens->prepare({dff::SweepPlan::even(4, 3.0, 0.0)});
        EXPECT_FALSE(lens->calibrated());
        EXPECT_EQ(lens->code(0), 220);
        EXPECT_EQ(lens->code(1), 160);
        EXPECT_EQ(lens->code(2), 100);
        EXPECT_EQ(lens->code(3), 40);
        lens->start();
        dynamic_cast<dff::SteppedLens &>(*lens).move_to(1);
        EXPECT_NE(autofocus().find("absolute: 160"), std::string::npos) << autofocus();
        EXPECT_NE(autofocus().find("continuous: 0"), std::string::npos) << autofocus();
        EXPECT_THROW(lens->prepare({dff::SweepPlan::even(20, 3.0, 0.0)}),
                     std::invalid_argument); /* 19 positions */
    }
    EXPECT_NE(autofocus().find("continuous: 1"), std::string::npos) << autofocus();
}

TEST(VideoLens, points_of_a_profile_say_where_it_goes)
{
    const std::string path = "/tmp/dff-points.yaml";
    std::ofstream(path) << "%YAML:1.0\n---\nlens: \"rig\"\nvergence: [ 0, 2 ]\nposition: [ 200, 61 ]\n";
    const auto lens = dff::open_lens(dff::LensUri::parse("v4l2:/dev/video0"), {path});
    EXPECT_TRUE(lens->calibrated());
    lens->prepare({dff::SweepPlan::even(3, 2.0, 0.0)});
    EXPECT_EQ(lens->code(0), 60); /* its steps are of 10 */
    EXPECT_EQ(lens->code(1), 130);
    EXPECT_EQ(lens->code(2), 200);
    EXPECT_THROW(lens->prepare({dff::SweepPlan::even(3, 3.0, 0.0)}), std::invalid_argument);

    std::ofstream(path) << "%YAML:1.0\n---\nlens: \"another\"\nvergence: [ 0, 2 ]\nposition: [ 0, 1023 ]\n";
    const auto other = dff::open_lens(dff::LensUri::parse("v4l2:/dev/video0"), {path});
    EXPECT_THROW(other->prepare({dff::SweepPlan::even(3, 2.0, 0.0)}), std::invalid_argument);
}

/* The kernel's simulated camera vimc has a lens as real sensors have: a sub-device of its own. */
TEST(SubdeviceLens, is_found_and_moved)
{
    std::string device;
    for (const dff::FoundLens &lens : dff::find_lenses(dff::this_machine()))
        if (lens.kind == dff::FoundLens::Kind::Subdevice)
            device = lens.device;
    ASSERT_NE(device.find("/dev/v4l-subdev"), std::string::npos);
    const auto lens = dff::open_lens(dff::LensUri::parse("v4l2:" + device), {});
    lens->prepare({dff::SweepPlan::even(3, 4.0, 0.0)});
    EXPECT_EQ(lens->code(0), 1023);
    EXPECT_EQ(lens->code(2), 0);
    lens->start();
    dynamic_cast<dff::SteppedLens &>(*lens).move_to(0);
    const auto told = controls_of(device, "focus_absolute");
    EXPECT_NE(told.find("absolute: 1023"), std::string::npos) << told;
    lens->stop();
}

TEST(EveryLens, two_hundred_starts_leave_no_file_open)
{
    const auto open_files = [] {
        return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                             std::filesystem::directory_iterator());
    };
    const std::string uris[] = {"fpga:" + rig::i2c_bus(), "max14574:" + rig::i2c_bus(), "v4l2:/dev/video0"};
    for (const std::string &uri : uris) {
        const auto before = open_files();
        for (int cycle = 0; cycle < 200; cycle++) {
            const auto lens = dff::open_lens(dff::LensUri::parse(uri), {});
            lens->prepare({dff::SweepPlan::even(2, 2.0, 0.0), 6400us, 6000us});
            lens->start();
            if (auto *stepped = dynamic_cast<dff::SteppedLens *>(lens.get()))
                stepped->move_to(1);
            lens->stop();
        }
        EXPECT_EQ(open_files(), before) << uri;
    }
}
