/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/engine_error.h"
#include "engine/opencl/device.h"
#include "engine/opencl/program_file.h"

#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>

using namespace dff;

namespace {

/* A cache folder of the test's own. */
class ProgramCacheTest : public testing::Test {
protected:
    ProgramCacheTest()
    {
        Device::open(""); /* PoCL has found its own folder, which it looks for in the same place, by then */
        std::string name = testing::TempDir() + "programs-XXXXXX";
        folder_ = mkdtemp(name.data());
        setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
    }
    ~ProgramCacheTest() override { std::filesystem::remove_all(folder_); }

    static std::unique_ptr<ProgramCache> new_process()
    {
        const auto device = Device::open("");
        return std::make_unique<ProgramCache>(device->context(), device->device());
    }

    std::vector<std::filesystem::path> files() const
    {
        std::vector<std::filesystem::path> found;
        for (const auto &entry : std::filesystem::recursive_directory_iterator(folder_))
            if (entry.is_regular_file())
                found.push_back(entry.path());
        return found;
    }

    static void expect_kernel(const cl::Program &program)
    {
        EXPECT_NO_THROW(cl::Kernel(program, "blur_rows"));
    }

    std::filesystem::path folder_;
};

} // namespace

TEST_F(ProgramCacheTest, a_program_is_built_once_a_process)
{
    ProgramCache &programs = Device::open("")->programs();
    const cl_program first = programs.get("gaussian_blur", "")();
    EXPECT_EQ(Device::open("")->programs().get("gaussian_blur", "")(), first);
    EXPECT_NE(programs.get("gaussian_blur", "-DOTHER")(), first);
}

TEST_F(ProgramCacheTest, the_next_process_finds_it_in_a_file)
{
    expect_kernel(new_process()->get("gaussian_blur", ""));
    ASSERT_EQ(files().size(), 1u);
    const auto written = std::filesystem::last_write_time(files().front());
    expect_kernel(new_process()->get("gaussian_blur", ""));
    EXPECT_EQ(files().size(), 1u);
    EXPECT_EQ(std::filesystem::last_write_time(files().front()), written);
}

TEST_F(ProgramCacheTest, a_broken_file_is_built_anew)
{
    new_process()->get("gaussian_blur", "");
    ASSERT_EQ(files().size(), 1u);
    const auto whole = std::filesystem::file_size(files().front());
    std::filesystem::resize_file(files().front(), whole - 20000); /* the key is whole, the binary is not */
    expect_kernel(new_process()->get("gaussian_blur", ""));
    EXPECT_EQ(std::filesystem::file_size(files().front()), whole);

    std::ofstream(files().front()) << "something else";
    expect_kernel(new_process()->get("gaussian_blur", ""));
}

TEST_F(ProgramCacheTest, works_where_nothing_can_be_written)
{
    setenv("XDG_CACHE_HOME", "/proc/nowhere", 1);
    expect_kernel(new_process()->get("gaussian_blur", ""));
}

TEST_F(ProgramCacheTest, a_file_is_read_by_its_own_key_only)
{
    const std::vector<unsigned char> binary{1, 0, 2};
    ProgramFile("key").write(binary);
    EXPECT_EQ(ProgramFile("key").read(), binary);
    EXPECT_FALSE(ProgramFile("other").read());
    std::filesystem::rename(files().front(),
                            files().front().parent_path() /
                                (std::to_string(std::hash<std::string>()("other")) + ".program"));
    EXPECT_FALSE(ProgramFile("other").read()) << "two keys of one hash";
}
