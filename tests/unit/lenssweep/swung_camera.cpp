/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "swung_camera.h"

#include <cmath>
#include <cstring>
#include <filesystem>

namespace {

std::uint64_t now_ns()
{
    return static_cast<std::uint64_t>(
        std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count());
}

/* False if the stop was requested before. */
bool wait_until(std::uint64_t time_ns, const std::stop_token &stop)
{
    while (!stop.stop_requested() && now_ns() < time_ns)
        std::this_thread::sleep_for(
            std::chrono::nanoseconds(std::min<std::uint64_t>(time_ns - now_ns(), 5'000'000)));
    return !stop.stop_requested();
}

/* mA, `phase` periods after an upper turn. */
double current_at(const FakeOptotune::Triangle &triangle, double phase)
{
    const double part = phase - std::floor(phase);
    const double down = part < 0.5 ? 2 * part : 2 - 2 * part;
    return triangle.upper - down * (triangle.upper - triangle.lower);
}

} // namespace

SwungCamera::SwungCamera(FakeOptotune &driver, unsigned frames_a_period, std::chrono::nanoseconds lag,
                         std::chrono::nanoseconds delay)
    : driver_(driver), frames_(frames_a_period), lag_ns_(lag.count()), delay_ns_(delay.count())
{
    std::string folder = std::filesystem::temp_directory_path() / "dff-pin-XXXXXX";
    folder_ = mkdtemp(folder.data());
    path_ = folder_ + "/pin";
    pin_ = std::make_unique<dff::LineServer>(path_, [](bool) {});
}

SwungCamera::~SwungCamera()
{
    stop();
    pin_.reset();
    std::filesystem::remove_all(folder_);
}

void SwungCamera::shoot_into(GstAppSrc *source)
{
    thread_ = std::jthread([this, source](const std::stop_token &stop) { run(stop, source); });
}

void SwungCamera::stop()
{
    thread_ = {};
}

void SwungCamera::push(GstAppSrc *source, std::uint64_t time_ns, double current)
{
    std::vector<guint8> pixels(static_cast<size_t>(side) * side,
                               static_cast<guint8>(std::lround(std::max(current, 0.0))));
    for (unsigned place = 0; place < pixels.size(); place++) {
        const double sharpest = 200.0 * place / static_cast<double>(pixels.size());
        const double off = (current - sharpest) / 100;
        if (place % 3 == 2)
            pixels[place] += static_cast<guint8>(std::lround(35 / (1 + off * off)));
    }
    GstBuffer *buffer = gst_buffer_new_memdup(pixels.data(), pixels.size());
    GST_BUFFER_PTS(buffer) = time_ns - gst_element_get_base_time(GST_ELEMENT(source));
    gst_app_src_push_buffer(source, buffer);
}

/* From the upper turn at that time to the next one. */
void SwungCamera::shoot_period(const std::stop_token &stop, GstAppSrc *source,
                               const FakeOptotune::Triangle &triangle, std::uint64_t edge_ns)
{
    const double slot_ns = 1e9 / triangle.hertz / frames_;
    if (!wait_until(edge_ns, stop))
        return;
    pin_->send(true, edge_ns);
    for (unsigned frame = 0; frame < frames_; ++frame) {
        const double begin_ns = slot_ns * frame + static_cast<double>(delay_ns_);
        const double seen_ns = begin_ns + slot_ns / 2 - static_cast<double>(lag_ns_);
        if (!wait_until(edge_ns + static_cast<std::uint64_t>(begin_ns + slot_ns / 2), stop))
            return;
        if (frame == frames_ / 2)
            pin_->send(false, edge_ns + static_cast<std::uint64_t>(slot_ns * frame));
        push(source, edge_ns + static_cast<std::uint64_t>(begin_ns),
             current_at(triangle, seen_ns / slot_ns / frames_));
    }
}

void SwungCamera::run(const std::stop_token &stop, GstAppSrc *source)
{
    std::uint64_t since_ns = 0;
    double turns = 0;
    while (!stop.stop_requested()) {
        const auto triangle = driver_.triangle();
        if (!triangle) {
            wait_until(now_ns() + 5'000'000, stop);
            continue;
        }
        /* A quarter of a period after it was half way up it turns. */
        const double period_ns = 1e9 / triangle->hertz;
        if (since_ns != triangle->since_ns)
            turns = std::ceil(static_cast<double>(now_ns() - triangle->since_ns) / period_ns) + 0.25;
        since_ns = triangle->since_ns;
        shoot_period(stop, source, *triangle,
                     since_ns + static_cast<std::uint64_t>(std::llround(turns * period_ns)));
        turns += 1;
    }
}
