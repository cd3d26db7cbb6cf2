/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */

/* dff-bench REPORT.md REPORT.json [--quick|--linearity]: what a stack costs, beside copies and other people's
 * ways to the same end. Everything runs in one process, in turn, so that ratios hold on a machine that is not
 * quiet. --quick: 1920x1080 alone; --linearity: ours alone, from VGA to 4K and from 4 planes to 32. */
#include "bench_stack.h"
#include "engine/aif_composer.h"
#include "engine/focus_engine.h"
#include "engine/stack_denoiser.h"
#include "engine/steady_depth.h"
#include "opencv_focus.h"
#include "plain_focus.h"
#include "report.h"

#ifdef HAVE_XIMGPROC
#include "opencv_solver.h"
#endif

#include <cstring>
#include <iostream>
#include <memory>

using namespace dff;
using namespace dff::bench;

namespace {

constexpr unsigned warm_up_rounds = 3; /* kernels are compiled, memory is touched, clocks are up */

/* Greatest resident memory since the last call, MiB. */
double peak_memory()
{
    double kilobytes = 0.0;
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (word == "VmHWM:")
            status >> kilobytes;
    std::ofstream("/proc/self/clear_refs") << "5";
    return kilobytes / 1024.0;
}

/* Depth and all-in-focus picture of one method. */
class Pipeline {
public:
    Pipeline(const BenchStack &stack, Method method, Prefer prefer = Prefer::Clearest)
        : stack_(stack), engine_(Device::open(""), stack.shape, parameters_of(method, prefer)),
          composer_(Device::open(""), stack.shape), depth_(size_t{stack.shape.width} * stack.shape.height),
          picture_(stack.memory.size() / stack.shape.planes),
          layout_(packed_layout({stack.shape.format, stack.shape.width, stack.shape.height, 1}))
    {
    }

    const StageTimes *run_depth(bool with_uncertainty = false)
    {
        DepthOutputs outputs;
        outputs.depth = {std::as_writable_bytes(std::span(depth_)).data(), stride()};
        if (with_uncertainty) {
            uncertainty_.resize(depth_.size());
            outputs.uncertainty = {std::as_writable_bytes(std::span(uncertainty_)).data(), stride()};
        }
        engine_.compute(stack_.view(), outputs);
        times_ = engine_.times();
        return &times_;
    }

    const StageTimes *run()
    {
        run_depth();
        compose(AifComposer::Blend::Linear);
        times_.insert(times_.end(), composer_.times().begin(), composer_.times().end());
        return &times_;
    }

    /* The picture of the last depth. */
    const StageTimes *compose(AifComposer::Blend blend)
    {
        composer_.compose(stack_.view(), {std::as_bytes(std::span(depth_)), stride()}, blend, picture_,
                          layout_);
        return &composer_.times();
    }

    std::vector<uint16_t> sparse_depth()
    {
        std::vector<uint16_t> sparse(depth_.size());
        DepthOutputs outputs;
        outputs.sparse = {std::as_writable_bytes(std::span(sparse)).data(), stride()};
        engine_.compute(stack_.view(), outputs);
        return sparse;
    }

private:
    static DepthParameters parameters_of(Method method, Prefer prefer)
    {
        DepthParameters parameters;
        parameters.method = method;
        parameters.prefer = prefer;
        return parameters;
    }

    size_t stride() const { return stack_.shape.width * sizeof(uint16_t); }

    const BenchStack &stack_;
    FocusEngine engine_;
    AifComposer composer_;
    std::vector<uint16_t> depth_, uncertainty_;
    std::vector<std::byte> picture_;
    std::vector<RowLayout> layout_;
    StageTimes times_;
};

/* Everything that is timed, with what it works on. Slow ways run in an odd number of the nine rounds. */
class Rows {
public:
    explicit Rows(const Case &c)
        : stack_(c.width, c.height, c.planes), copy_(stack_.memory.size()), paper_(stack_, Method::Paper),
          volume_(stack_, Method::Volume), denoiser_(Device::open(""), stack_.shape),
          denoised_(stack_.memory.size()), steady_(stack_.shape),
          steady_depth_(size_t{stack_.shape.width} * stack_.shape.height, 20000)
    {
        std::memcpy(denoised_.data(), stack_.memory.data(), denoised_.size());
        rows_.push_back({"memory copy", Row::Kind::Copy, 1, [this] {
                             std::memcpy(copy_.data(), stack_.memory.data(), copy_.size());
                             return nullptr;
                         }});
        rows_.push_back({"method=paper", Row::Kind::Ours, 1, [this] { return paper_.run_depth(); }});
        rows_.push_back({"method=paper and AIF", Row::Kind::Ours, 1, [this] { return paper_.run(); }});
        rows_.push_back({"method=volume", Row::Kind::Ours, 1, [this] { return volume_.run_depth(); }});
        rows_.push_back({"method=volume with uncertainty", Row::Kind::Part, 1,
                         [this] { return volume_.run_depth(true); }});
        rows_.push_back({"method=volume and AIF", Row::Kind::Ours, 1, [this] { return volume_.run(); }});
        rows_.push_back({"AIF alone, blend=sharp", Row::Kind::Part, 1,
                         [this] { return volume_.compose(AifComposer::Blend::Sharp); }});
        add_time();
        if (c.with_others) {
            preferring_ = std::make_unique<Pipeline>(stack_, Method::Volume, Prefer::Near);
            rows_.push_back({"method=volume prefer=near", Row::Kind::Part, 3,
                             [this] { return preferring_->run_depth(); }});
            add_deep_colour();
            add_others();
        }
    }

    /* What the stacks before are good for. The same stack again and again stands still. */
    void add_time()
    {
        rows_.push_back({"focalstackdenoise", Row::Kind::Part, 1, [this] {
                             const StackView view{stack_.shape, denoised_, packed_layout(stack_.shape)};
                             denoiser_.denoise(view, denoised_, 0, {});
                             return nullptr;
                         }});
        rows_.push_back({"steady depth", Row::Kind::Part, 1, [this] {
                             DepthJumps jumps;
                             jumps.fill(4000);
                             steady_.steady(stack_.view(),
                                            {std::as_writable_bytes(std::span(steady_depth_)).data(),
                                             stack_.shape.width * sizeof(uint16_t)},
                                            jumps);
                             return nullptr;
                         }});
    }

    void run(unsigned rounds)
    {
        for (unsigned round = 0; round < warm_up_rounds; round++)
            for (Row &row : rows_)
                row.work();
        for (unsigned round = 0; round < rounds; round++)
            for (Row &row : rows_)
                if (round % row.every == 0)
                    row.run();
    }

    const std::vector<Row> &rows() const { return rows_; }

private:
    void add_deep_colour()
    {
        deep_stack_ = std::make_unique<BenchStack>(stack_.in_deep_colour());
        deep_paper_ = std::make_unique<Pipeline>(*deep_stack_, Method::Paper);
        deep_volume_ = std::make_unique<Pipeline>(*deep_stack_, Method::Volume);
        rows_.push_back(
            {"RGBA64_LE: method=paper and AIF", Row::Kind::Part, 3, [this] { return deep_paper_->run(); }});
        rows_.push_back(
            {"RGBA64_LE: method=volume and AIF", Row::Kind::Part, 3, [this] { return deep_volume_->run(); }});
        rows_.push_back({"RGBA64_LE: AIF alone, blend=sharp", Row::Kind::Part, 3,
                         [this] { return deep_volume_->compose(AifComposer::Blend::Sharp); }});
    }

    void add_others()
    {
        const auto add_sum = [this](const char *name,
                                    std::function<double(std::span<const uint8_t>, int, int, int)> sum) {
            rows_.push_back({name, Row::Kind::Others, 3, [this, sum = std::move(sum)] {
                                 sum(stack_.luma, static_cast<int>(stack_.shape.width),
                                     static_cast<int>(stack_.shape.height),
                                     static_cast<int>(stack_.shape.planes));
                                 return nullptr;
                             }});
        };
        add_sum("focus measure, plain C++, 1 thread", plain_focus_measure);
        add_sum("focus measure, OpenCV", opencv_focus_measure);
        add_sum("focus measure and entropy, OpenCV",
                [](auto... luma) { return opencv_focus_measure(luma...) + opencv_entropy(luma...); });
#ifdef HAVE_XIMGPROC
        solver_ = std::make_unique<OpencvSolver>(stack_, paper_.sparse_depth());
        rows_.push_back({"fast bilateral solver, OpenCV", Row::Kind::Others, 4, [this] {
                             solver_->run();
                             return nullptr;
                         }});
        rows_.push_back(
            {"fast bilateral solver, OpenCV, cells as large as ours", Row::Kind::Others, 4, [this] {
                 solver_->run_with_our_cells();
                 return nullptr;
             }});
#endif
    }

    BenchStack stack_;
    std::vector<std::byte> copy_;
    Pipeline paper_, volume_;
    std::unique_ptr<BenchStack> deep_stack_;
    std::unique_ptr<Pipeline> deep_paper_, deep_volume_, preferring_;
#ifdef HAVE_XIMGPROC
    std::unique_ptr<OpencvSolver> solver_;
#endif
    StackDenoiser denoiser_;
    std::vector<std::byte> denoised_;
    SteadyDepth steady_;
    std::vector<uint16_t> steady_depth_;
    std::vector<Row> rows_;
};

void measure(const Case &c, unsigned rounds, Report &report)
{
    std::cerr << c.width << "x" << c.height << " N=" << c.planes << "\n";
    peak_memory();
    Rows rows(c);
    rows.run(rounds);
    report.add(c, rows.rows(), peak_memory());
}

} // namespace

int main(int count, char **arguments)
{
    const std::string_view option = count > 3 ? arguments[3] : "";
    if (count < 3 || (!option.empty() && option != "--quick" && option != "--linearity")) {
        std::cerr << "usage: dff-bench REPORT.md REPORT.json [--quick|--linearity]\n";
        return 2;
    }
    std::vector<Case> cases;
    if (option != "--linearity")
        for (const auto &[width, height] : {std::pair(1280u, 720u), {1920u, 1080u}, {3840u, 2160u}})
            for (const uint32_t planes : {6u, 10u})
                if (option.empty() || width == 1920)
                    cases.push_back({width, height, planes, true});
    if (option != "--quick")
        for (const auto &[width, height] :
             {std::pair(640u, 480u), {1280u, 720u}, {1920u, 1080u}, {3840u, 2160u}})
            for (const uint32_t planes : {4u, 8u, 16u, 32u})
                cases.push_back({width, height, planes, false});

    Report report(arguments[1], arguments[2]);
    for (const Case &c : cases)
        measure(c, option == "--linearity" ? 5 : 9, report);
}
