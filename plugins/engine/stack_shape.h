/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace dff {

enum class PixelFormat { Gray8, Gray16, I420, Nv12, Rgb, Bgr, Rgbx, Bgrx, Rgba64 };

/* 1, or 2 (little endian). */
uint32_t sample_bytes(PixelFormat format);

/* One component plane of a picture (luma, chroma, or interleaved colours), as rows of samples. */
struct Component {
    uint32_t width;        /* samples a row, interleaved channels counted one by one */
    uint32_t height;       /* rows */
    uint32_t channels;     /* interleaved channels */
    uint32_t subsampling;  /* picture pixels a sample in each direction: 1 or 2 */
    uint32_t sample_bytes; /* see sample_bytes() */
};

struct StackShape {
    PixelFormat format;
    uint32_t width;
    uint32_t height;
    uint32_t planes;

    std::vector<Component> components() const;

    bool operator==(const StackShape &) const = default;
};

/* Bytes of a stack without any padding. */
uint64_t bytes_of(const StackShape &shape);

/* Where a component's rows lie in the stack's memory, in bytes. Laid out as the kernels' ulong2. */
struct RowLayout {
    uint64_t offset;
    uint64_t stride;

    bool operator==(const RowLayout &) const = default;
};

/* Which plane of which sweep a picture is. */
struct PlaneIdentity {
    uint64_t sweep;
    uint32_t plane;

    bool operator==(const PlaneIdentity &) const = default;
};

class SharedUpload;

/* A stack in host memory: `layout[component * planes + z]` says where each component of each plane lies. */
struct StackView {
    StackShape shape;
    std::span<const std::byte> memory;
    std::vector<RowLayout> layout;

    /* A plane each, where its picture is known to be its own; empty where nothing is known. */
    std::vector<std::optional<PlaneIdentity>> identities = {};

    /* Of this memory, where other engines get the same stack; nullptr: each engine uploads it. */
    std::shared_ptr<SharedUpload> upload = nullptr;

    /* Standard deviation of the noise of its luma, of 255, where that is known better than from the stack
     * itself, and the same in all planes. */
    std::optional<float> noise = {};
};

/* Whether the layout has a place for each component of each plane, and all of it lies in the memory. */
bool lies_within_memory(const StackView &stack);

/* Whether the rows of `component` lie in `bytes`. */
bool lies_within(const Component &component, const RowLayout &rows, uint64_t bytes);

/* Layout of planes that follow each other in one memory without any padding. For tests and plain
 * applications. */
std::vector<RowLayout> packed_layout(const StackShape &shape);

} // namespace dff
