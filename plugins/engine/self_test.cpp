/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/self_test.h"

#include "engine/engine_error.h"
#include "engine/focus_engine.h"
#include "engine/self_test_results.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace dff::self_test {

namespace {

constexpr unsigned spacing = 8;         /* of the places */
constexpr unsigned square = 64;         /* pixels, by turns bright and dark */
constexpr unsigned blur_step = 4;       /* pixels of blur's diameter a plane */
constexpr uint8_t tolerance = 255 / 50; /* of a depth */

/* The same on every machine. */
uint8_t grain(unsigned x, unsigned y)
{
    uint32_t hash = x * 374761393U + y * 668265263U;
    hash = (hash ^ (hash >> 13)) * 1274126177U;
    return static_cast<uint8_t>(hash >> 20);
}

/* A component sharp everywhere, for its mean over any rectangle. */
class Texture {
public:
    Texture(unsigned width, unsigned height)
        : width_(width), height_(height), sums_((size_t{width} + 1) * (height + 1))
    {
        for (unsigned y = 0; y < height; y++)
            for (unsigned x = 0; x < width; x++) {
                const unsigned light = ((x / square + y / square) & 1U) * 64;
                sum(x + 1, y + 1) = sum(x, y + 1) + sum(x + 1, y) - sum(x, y) + 32 + light + grain(x, y) / 2;
            }
    }

    uint8_t mean_around(unsigned x, unsigned y, unsigned radius) const
    {
        const unsigned left = x - std::min(x, radius), right = std::min(x + radius + 1, width_);
        const unsigned top = y - std::min(y, radius), bottom = std::min(y + radius + 1, height_);
        const unsigned total = sum(right, bottom) - sum(left, bottom) - sum(right, top) + sum(left, top);
        return static_cast<uint8_t>(total / std::max((right - left) * (bottom - top), 1U));
    }

private:
    uint32_t &sum(unsigned x, unsigned y) { return sums_[size_t{y} * (width_ + 1) + x]; }
    uint32_t sum(unsigned x, unsigned y) const { return sums_[size_t{y} * (width_ + 1) + x]; }

    unsigned width_, height_;
    std::vector<uint32_t> sums_; /* of all above and to the left */
};

} // namespace

float truth(const StackShape &shape, unsigned x, unsigned y)
{
    const auto along = static_cast<float>(x + y);
    return static_cast<float>(shape.planes - 1) * along / static_cast<float>(shape.width + shape.height);
}

std::vector<std::byte> stack(const StackShape &shape)
{
    const std::vector<RowLayout> layout = packed_layout(shape);
    const std::vector<Component> components = shape.components();
    std::vector<std::byte> memory(bytes_of(shape));
    for (size_t c = 0; c < components.size(); c++) {
        const Component &component = components[c];
        const unsigned step = component.subsampling;
        const Texture texture(component.width, component.height);
        for (unsigned z = 0; z < shape.planes; z++)
            for (unsigned y = 0; y < component.height; y++)
                for (unsigned x = 0; x < component.width; x++) {
                    const float off = std::abs(static_cast<float>(z) - truth(shape, x * step, y * step));
                    const auto radius = static_cast<unsigned>(off * blur_step / 2 / static_cast<float>(step));
                    const RowLayout &rows = layout[c * shape.planes + z];
                    memory[rows.offset + rows.stride * y + x] =
                        static_cast<std::byte>(texture.mean_around(x, y, radius));
                }
    }
    return memory;
}

std::vector<Place> places()
{
    std::vector<Place> all;
    for (unsigned y = spacing / 2; y < shape.height; y += spacing)
        for (unsigned x = y / spacing * 3 % spacing; x < shape.width; x += spacing)
            all.push_back({x, y});
    return all;
}

std::vector<uint8_t> depth_on(const std::shared_ptr<Device> &device, Method method)
{
    const std::vector<std::byte> memory = stack();
    std::vector<uint16_t> depth(size_t{shape.width} * shape.height);
    DepthParameters parameters;
    parameters.method = method;
    FocusEngine engine(device, shape, parameters);
    const StackView view{.shape = shape, .memory = memory, .layout = packed_layout(shape)};
    DepthOutputs outputs;
    outputs.depth = {std::as_writable_bytes(std::span(depth)).data(), shape.width * sizeof(uint16_t)};
    engine.compute(view, outputs);
    std::vector<uint8_t> found;
    for (const auto &[x, y] : places())
        found.push_back(static_cast<uint8_t>(depth[size_t{y} * shape.width + x] >> 8));
    return found;
}

std::span<const uint8_t> stored(Method method)
{
    return method == Method::Paper ? std::span(stored_paper) : std::span(stored_volume);
}

double difference(std::span<const uint8_t> a, std::span<const uint8_t> b)
{
    size_t others = 0;
    for (size_t i = 0; i < a.size(); i++)
        others += std::abs(a[i] - b[i]) > tolerance;
    return static_cast<double>(others) / static_cast<double>(a.size());
}

bool passes(const std::shared_ptr<Device> &device)
{
    try {
        return std::ranges::all_of(std::array{Method::Paper, Method::Volume}, [&](Method method) {
            return difference(depth_on(device, method), stored(method)) <= largest_difference;
        });
    } catch (const EngineError &) {
        return false;
    } catch (const cl::Error &) {
        return false;
    }
}

} // namespace dff::self_test
