/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "proofs.h"
#include "own_network.h"

#include <cstdio>
#include <cstdlib>
#include <gst/gst.h>
#include <gtest/gtest.h>

namespace dff {

namespace {

constexpr int skipped = 77; /* what Meson takes for a skip */

double number(const char *variable, double otherwise)
{
    const char *text = std::getenv(variable);
    return text ? std::atof(text) : otherwise;
}

} // namespace

double seconds_of_proof(double otherwise)
{
    return number("DFF_RIG_SECONDS", otherwise);
}

int cycles_of_proof(int otherwise)
{
    return static_cast<int>(number("DFF_RIG_CYCLES", otherwise));
}

int rate_of_proof(int otherwise)
{
    return static_cast<int>(number("DFF_RIG_RATE", otherwise));
}

void expect_accounts_agree(const WatchedStream &stream, const BenchProcess::Counts &bench)
{
    const auto exposed = static_cast<uint64_t>(bench.at("exposed"));
    /* A frame that is late is one that never came, to Aravis. What else is lost, this machine's network lost.
     */
    const auto lost = static_cast<uint64_t>(bench.at("lost") + bench.at("late"));
    std::printf(
        "bench camera: %lu frames, %lu of them lost; lenssweepsrc: %lu delivered, %lu unlabelled, %lu lost\n",
        exposed, lost, stream.stat("delivered"), stream.stat("unlabelled"), stream.stat("lost"));
    const uint64_t known = stream.stat("delivered") + stream.stat("unlabelled") + stream.stat("lost");
    EXPECT_EQ(stream.stat("restarts"), 0U) << "this machine is too slow for the rate";
    EXPECT_EQ(known, exposed);
    EXPECT_GE(stream.stat("lost"), lost);
    EXPECT_EQ(stream.stat("delivered"), stream.watched().frames);
}

} // namespace dff

int main(int argc, char **argv)
{
    if (!dff::enter_own_network()) {
        std::puts("skipped: a network namespace of its own needs root");
        return dff::skipped;
    }
    gst_init(&argc, &argv);
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
