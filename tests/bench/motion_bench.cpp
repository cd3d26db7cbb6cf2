/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */

/* motion-bench [ROUNDS]: what focalstackdenoise costs a stack of 1920x1080, N=6, while a ball flies by in the
 * dark, part by part, as Markdown: medians of wall and of processor time. Last a number that stays the same
 * as long as what comes out does. */
#include "bench_stack.h"
#include "focalstack/sweep_follower.h"
#include "row.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <opencv2/core.hpp>

using namespace dff;
using namespace dff::bench;

namespace {

constexpr uint32_t width = 1920, height = 1080, planes = 6;
constexpr double speed = 4.0;                       /* pixels a plane */
constexpr int radius = 54;                          /* pixels */
constexpr double noise = 4.0;                       /* standard deviation, of 255 */
constexpr unsigned sweeps = 8, warm_up_rounds = 35; /* noise is learned more seldom then */
constexpr DenoiseParameters parameters{16, 1.0F};

/* A ball that is lit from the left, at a time in planes. */
void draw_ball(cv::Mat luma, double time)
{
    const cv::Point2d centre(600.0 + speed * time, 500.0 + 0.25 * speed * time);
    for (int y = -radius; y <= radius; y++)
        for (int x = -radius; x <= radius; x++)
            if (x * x + y * y < radius * radius) {
                const double texture = std::sin(0.4 * x) * std::sin(0.3 * y);
                luma.at<uint8_t>(cvRound(centre.y) + y, cvRound(centre.x) + x) =
                    cv::saturate_cast<uint8_t>(150.0 - 0.8 * x + 40.0 * texture);
            }
}

/* Some sweeps, one after the other, with noise of their own. */
std::vector<std::vector<std::byte>> make_sweeps(const BenchStack &still)
{
    cv::RNG random(1);
    std::vector<std::vector<std::byte>> all;
    for (unsigned i = 0; i < sweeps; i++) {
        all.push_back(still.memory);
        const auto pictures = pictures_of({still.shape, all.back(), still.layout}, all.back());
        for (uint32_t z = 0; z < planes; z++) {
            draw_ball(pictures[z].front(), i * planes + z);
            for (const cv::Mat &picture : pictures[z]) {
                cv::Mat1s grain(picture.size());
                random.fill(grain, cv::RNG::NORMAL, 0.0, noise);
                cv::add(picture, grain, picture, cv::noArray(), CV_8U);
            }
        }
    }
    return all;
}

/* FNV-1a over eight bytes at a time. */
uint64_t folded(uint64_t before, std::span<const std::byte> bytes)
{
    for (size_t i = 0; i + sizeof before <= bytes.size(); i += sizeof before) {
        uint64_t word = 0;
        std::memcpy(&word, bytes.data() + i, sizeof word);
        before = (before ^ word) * 0x100000001b3;
    }
    return before;
}

} // namespace

int main(int count, char **arguments)
{
    const int rounds = count > 1 ? std::max(1, std::atoi(arguments[1])) : 40;
    const BenchStack still(width, height, planes);
    const auto all = make_sweeps(still);
    std::vector<std::byte> memory(still.memory.size());
    const StackView view{still.shape, memory, still.layout};
    StackDenoiser denoiser(Device::open(""), still.shape);
    SweepFollower follower(still.shape);
    DenoiseReport report;
    std::span<const uint8_t> held;
    Row rows[] = {
        {"look for motion", Row::Kind::Part, 1,
         [&] {
             held = follower.look(view, memory, report);
             return nullptr;
         }},
        {"denoise", Row::Kind::Part, 1,
         [&] {
             denoiser.denoise(view, memory, 0, parameters, held);
             report = denoiser.report();
             return nullptr;
         }},
        {"follow motion", Row::Kind::Part, 1,
         [&] {
             follower.follow(view, memory, denoiser);
             return nullptr;
         }},
    };
    uint64_t sum = 0xcbf29ce484222325;
    for (unsigned round = 0; round < warm_up_rounds + static_cast<unsigned>(rounds); round++) {
        memory = all[round % sweeps];
        for (Row &row : rows)
            round < warm_up_rounds ? static_cast<void>(row.work()) : row.run();
        sum = folded(sum, memory);
    }
    std::printf("| | ms | processor ms |\n|---|---|---|\n");
    for (const Row &row : rows)
        std::printf("| %s | %.2f | %.2f |\n", row.name.c_str(), median(row.wall), median(row.processor));
    std::printf("\n%.1f %% moved; %016llx\n", 100.0 * follower.moved(), static_cast<unsigned long long>(sum));
}
