/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* dff-calibrate as it is used: boards before a camera of GigE Vision, recorded, and looked at by the program.
 */
#include "board_rig.h"
#include "calibration_file.h"
#include "proofs.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

using namespace dff;

namespace {

constexpr char optics[] = " planes=6 near=3.4 far=0.7";

class Calibrate : public testing::Test {
protected:
    Calibrate()
    {
        std::string folder = std::filesystem::temp_directory_path() / "dff-calibrate-XXXXXX";
        folder_ = mkdtemp(folder.data());
    }
    ~Calibrate() override { std::filesystem::remove_all(folder_); }

    /* The bench camera before a board. */
    std::vector<std::string> bench_options(const std::string &pose, const std::string &breathing) const
    {
        return {"--near=3.4",
                "--far=0.7",
                "--scene=board",
                "--board=10x7x20",
                "--calibration=" + rig_.camera(),
                "--pose=" + pose,
                "--breathing=" + breathing,
                "--field-curvature=0.5",
                "--vignetting=0.05",
                "--noise=moderate"};
    }

    /* A few sweeps, and where they lie. */
    std::string record(const std::string &pose, const std::string &breathing = "0.03")
    {
        const BenchProcess bench(bench_options(pose, breathing));
        const std::string file = folder_ / (std::to_string(recordings_++) + ".gdp");
        g_autoptr(GError) error = nullptr;
        g_autoptr(GstElement) pipeline = gst_parse_launch((bench.source() + optics +
                                                           " num-buffers=12 ! dffmetapay ! gdppay ! "
                                                           "filesink location=" +
                                                           file)
                                                              .c_str(),
                                                          &error);
        if (error)
            throw std::runtime_error(error->message);
        gst_element_set_state(pipeline, GST_STATE_PLAYING);
        g_autoptr(GstBus) bus = gst_element_get_bus(pipeline);
        g_autoptr(GstMessage) end = gst_bus_timed_pop_filtered(
            bus, 30 * GST_SECOND, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
        gst_element_set_state(pipeline, GST_STATE_NULL);
        EXPECT_TRUE(end && GST_MESSAGE_TYPE(end) == GST_MESSAGE_EOS) << pose;
        return file;
    }

    /* The program's exit status; it says in `said` what it says. */
    int run(const std::string &arguments)
    {
        const std::string told = folder_ / "told";
        const int status =
            std::system((DFF_CALIBRATE " --board 10x7x20 " + arguments + " >" + told + " 2>&1").c_str());
        std::ostringstream text;
        text << std::ifstream(told).rdbuf();
        said = text.str();
        return WEXITSTATUS(status);
    }

    std::string file(const char *name) const { return folder_ / name; }

    BoardRig rig_;
    std::string said;

private:
    std::filesystem::path folder_;
    int recordings_ = 0;
};

} // namespace

TEST_F(Calibrate, boards_before_a_camera_tell_what_the_rig_is_and_when_it_has_changed)
{
    std::string recordings;
    for (const std::string &pose : rig_.poses())
        recordings += " --recording " + record(pose);
    const std::string found = file("found.yml");
    ASSERT_EQ(run("--output " + found + recordings), 0) << said;
    rig_.expect_found(read_calibration(found));

    /* Live, and as it was. */
    const std::string &pose = rig_.poses()[3];
    {
        const BenchProcess bench(bench_options(pose, "0.03"));
        EXPECT_EQ(run("--boards 1 --check " + found + " --source \"" + bench.source() + optics + "\""), 0)
            << said;
    }
    EXPECT_EQ(run("--check " + found + " --recording " + record(pose, "0.015")), 1) << said;
    EXPECT_NE(said.find("does not fit any more"), std::string::npos) << said;
}
