/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/denoise_strips.h"
#include "engine/opencl/host_buffer.h"
#include "engine/plane_tracker.h"

namespace dff {

struct DenoisedComponent;

struct DenoiseParameters {
    uint32_t frames = 8;   /* sweeps that are averaged at most: 1 to 255 */
    float strength = 1.0f; /* how much change passes for noise: 1 is six standard deviations */
};

/* A rectangle of one component's samples in one plane. */
struct BackgroundPart {
    size_t component;
    uint32_t z;
    uint32_t x, y, width, height; /* in samples: three a pixel where colours are interleaved */
    std::vector<std::byte> samples;
};

/* What the denoiser knows after a stack. */
struct DenoiseReport {
    std::vector<NoiseCurve> noise; /* of each component (luma and chroma, or interleaved colours) */
    std::vector<float> spread;     /* of each component's tiles, see spread_of_tiles() */
    double sample_unit = 1.0;      /* of the noise, where white is 256 */
    double mean_sweeps = 0.0;      /* that were averaged, over all tiles and planes */
    std::optional<double> left;    /* noise of the denoised luma, a standard deviation in steps of 8 bits: the
                                      median over the picture; known from the second stack on */
};

/* Averages each plane of a focal stack with the same plane of the stacks before, in tiles of 8x8 pixels,
 * where nothing moved: kernels/stack_denoise.cl. What is noise and what is motion goes by a noise curve that
 * is estimated from the stacks themselves. */
class StackDenoiser {
public:
    /* Throws EngineError. */
    StackDenoiser(std::shared_ptr<Device> device, const StackShape &shape);

    /* Denoises the stack in place: `memory` are the bytes of `view`. Planes whose bit is set in `absent` do
     * not show what they should (lost, or another plane's picture) and stay as they are. So do tiles of 8x8
     * pixels where `held` is not 0 ([plane][tile], or empty), and what stands behind is remembered there.
     * Throws EngineError. */
    void denoise(const StackView &view, std::span<std::byte> memory, uint64_t absent,
                 const DenoiseParameters &parameters, std::span<const uint8_t> held = {});

    /* What stands still, as the mean of the sweeps: fills the samples in. Reads back from the device. */
    void background(std::span<BackgroundPart> parts);

    /* The next stack shows at pixel (x, y) what the last one showed at (x + right, y + down): all that is
     * known moves along. Even numbers, so that chroma of half the size moves by whole samples. Throws
     * EngineError. */
    void shift(int right, int down);

    /* The next stack shows another scene: nothing before it is averaged with it. */
    void forget() { has_means_ = false; }

    /* Of the last stack. */
    DenoiseReport report() const;

    StageTimes times() const { return times_; }

private:
    void shift_sweeps(int right, int down);
    void upload(const StackView &view, std::span<std::byte> memory);
    void begin(const StackView &view);
    void hold(std::span<const uint8_t> held);
    void look_at_noise(const StackView &view, uint32_t z);
    void measure();
    void judge(const DenoiseParameters &parameters);
    void average(const DenoiseParameters &parameters, uint64_t wanted, uint64_t absent);
    void make_strips();
    void run_strips(const DenoiseParameters &parameters, uint64_t wanted, uint64_t absent);
    void run_tiles(const DenoiseParameters &parameters, uint64_t wanted, uint64_t absent);
    uint32_t learned_step() const;
    void read_tiles();
    std::vector<uint8_t> learned_sweeps() const;
    bool all_moved() const;
    void learn_noise();
    void tell_noise_left(uint32_t frames);
    template <typename... Arguments> void enqueue_tiles(cl::Kernel &kernel, const Arguments &...arguments);
    size_t tiles_a_plane() const
    {
        return static_cast<size_t>(tiles_.s[0]) * static_cast<size_t>(tiles_.s[1]);
    }

    std::shared_ptr<Device> device_;
    CommandQueue queue_;
    StackShape shape_;
    cl_int2 tiles_; /* across and down */
    cl_int run_;    /* tiles a work-item */
    HostBuffer bytes_;
    cl::Buffer moved_, sweeps_, held_;
    std::vector<uint8_t> host_sweeps_; /* sweeps_, as the last stack left it */
    bool holds_ = true;                /* held_ has anything but 0 in it */
    std::vector<std::shared_ptr<DenoisedComponent>> components_;
    std::optional<DenoiseStrips> strips_; /* on CPUs */
    PlaneTracker tracker_;
    bool has_means_ = false;
    bool has_learned_ = false;   /* noise from the difference of two sweeps */
    uint32_t kept_sweeps_ = 1;   /* since begin(), at most `frames` */
    double kept_variance_ = 1.0; /* of their mean, of one sweep's */
    std::optional<double> left_; /* DenoiseReport::left */
    uint64_t stacks_ = 0;        /* since begin() */
    bool learns_ = true;         /* noise, from this stack */
    uint32_t learned_plane_ = 0; /* which told of noise last */
    StageTimes times_;
};

} // namespace dff
