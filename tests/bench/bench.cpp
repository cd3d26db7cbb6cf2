/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */

/* dff-bench REPORT.md REPORT.json [--quick|--linearity]: what a stack costs, beside copies and other people's
 * ways to the same end. Everything runs in one process, in turn, so that ratios hold on a machine that is not
 * quiet. --quick: 1920x1080 alone; --linearity: ours alone, from VGA to 4K and from 4 planes to 32. */
#include "bench_stack.h"
#include "engine/aif_composer.h"
#include "plain_focus.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <fstream>
#include <functional>
#include <iostream>
#include <sstream>
#include <sys/resource.h>

#ifdef HAVE_XIMGPROC
#include <opencv2/imgproc.hpp>
#include <opencv2/ximgproc/edge_filter.hpp>
#endif

using namespace dff;
using namespace dff::bench;

namespace {

double seconds_of(const timeval &time)
{
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double cpu_ms()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1e3 * (seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime));
}

double wall_ms()
{
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

double median(std::vector<double> values)
{
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

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

/* Something that is timed: the whole of it, and its stages where it has some. */
struct Row {
    std::string name;
    unsigned every; /* rounds in which it runs once: slow ones need fewer */
    std::function<const StageTimes *()> work;
    std::vector<double> wall, cpu;
    std::vector<std::pair<std::string, std::vector<double>>> stages;

    void run()
    {
        const double wall_start = wall_ms(), cpu_start = cpu_ms();
        const StageTimes *times = work();
        cpu.push_back(cpu_ms() - cpu_start);
        wall.push_back(wall_ms() - wall_start);
        for (size_t i = 0; times && i < times->size(); i++) {
            if (stages.size() <= i)
                stages.emplace_back((*times)[i].first, std::vector<double>());
            stages[i].second.push_back((*times)[i].second);
        }
    }
};

/* Depth and all-in-focus picture of one method. */
class Pipeline {
public:
    Pipeline(const BenchStack &stack, Method method)
        : stack_(stack), engine_(Device::open(""), stack.shape, parameters_of(method)),
          composer_(Device::open(""), stack.shape), depth_(size_t{stack.shape.width} * stack.shape.height),
          picture_(stack.memory.size() / stack.shape.planes),
          layout_(packed_layout({stack.shape.format, stack.shape.width, stack.shape.height, 1}))
    {
    }

    const StageTimes *run()
    {
        const size_t stride = stack_.shape.width * sizeof(uint16_t);
        DepthOutputs outputs;
        outputs.depth = {std::as_writable_bytes(std::span(depth_)).data(), stride};
        engine_.compute(stack_.view(), outputs);
        composer_.compose(stack_.view(), {std::as_bytes(std::span(depth_)), stride},
                          AifComposer::Blend::Linear, picture_, layout_);
        times_ = engine_.times();
        times_.insert(times_.end(), composer_.times().begin(), composer_.times().end());
        return &times_;
    }

private:
    static DepthParameters parameters_of(Method method)
    {
        DepthParameters parameters;
        parameters.method = method;
        return parameters;
    }

    const BenchStack &stack_;
    FocusEngine engine_;
    AifComposer composer_;
    std::vector<uint16_t> depth_;
    std::vector<std::byte> picture_;
    std::vector<RowLayout> layout_;
    StageTimes times_;
};

#ifdef HAVE_XIMGPROC
/* OpenCV's fast bilateral solver on a map of the same size, with a guide in colours and defaults. */
void opencv_solver(const BenchStack &stack)
{
    const int width = static_cast<int>(stack.shape.width), height = static_cast<int>(stack.shape.height);
    const cv::Mat luma(height, width, CV_8U, const_cast<uint8_t *>(stack.luma.data())); /* only read */
    const cv::Mat confidence(height, width, CV_32F, cv::Scalar(0.1));
    cv::Mat guide, filled;
    cv::cvtColor(luma, guide, cv::COLOR_GRAY2BGR);
    cv::ximgproc::fastBilateralSolverFilter(guide, luma, confidence, filled);
}
#endif

struct Case {
    uint32_t width, height, planes;
    bool with_others;
};

class Report {
public:
    Report(const char *markdown, const char *json) : markdown_(markdown), json_(json) { json_ << "[\n"; }
    ~Report()
    {
        json_ << "\n]\n";
        markdown_ << "\n## Linearity\n\nMilliseconds a million pixels and plane; flat is linear.\n\n"
                  << "| | N | paper and AIF | its processor time | volume and AIF | its processor time |\n"
                  << "|---|---|---|---|---|---|\n"
                  << linearity_.str();
    }

    void add(const Case &c, const std::vector<Row> &rows, double memory_mib)
    {
        const double copy = median(rows.front().wall);
        markdown_ << "\n## " << c.width << "x" << c.height << ", N=" << c.planes << "\n\n"
                  << "Peak memory of the process: " << static_cast<int>(memory_mib) << " MiB.\n\n"
                  << "| | ms | of a copy | stacks/s | processor ms |\n|---|---|---|---|---|\n";
        for (const Row &row : rows) {
            const double wall = median(row.wall), cpu = median(row.cpu);
            markdown_ << "| " << row.name << " | " << rounded(wall) << " | " << rounded(wall / copy) << " | "
                      << rounded(1e3 / wall) << " | " << rounded(cpu) << " |\n";
            for (const auto &[stage, times] : row.stages)
                markdown_ << "| &nbsp;&nbsp;" << stage << " | " << rounded(median(times)) << " | "
                          << rounded(median(times) / copy) << " | | |\n";
            json_row(c, row, wall, cpu, copy, memory_mib);
        }
        compare(c, rows);
        markdown_.flush();
    }

private:
    static double rounded(double value) { return std::round(value * 100.0) / 100.0; }

    /* Rows 1 and 2 are method=paper and method=volume, the others' ways come after. */
    void compare(const Case &c, const std::vector<Row> &rows)
    {
        const double paper = median(rows[1].wall), volume = median(rows[2].wall);
        const double megapixel_planes = 1e-6 * c.width * c.height * c.planes;
        linearity_ << "| " << c.width << "x" << c.height << " | " << c.planes << " | "
                   << rounded(paper / megapixel_planes) << " | "
                   << rounded(median(rows[1].cpu) / megapixel_planes) << " | "
                   << rounded(volume / megapixel_planes) << " | "
                   << rounded(median(rows[2].cpu) / megapixel_planes) << " |\n";
        const auto processor_ratio = [&](size_t i, size_t ours) {
            return rounded(median(rows[i].cpu) / median(rows[ours].cpu));
        };
        for (size_t i = 3; i < rows.size(); i++)
            markdown_ << (i == 3 ? "\n" : "") << "Times as fast as \"" << rows[i].name
                      << "\" alone, with AIF: method=paper " << rounded(median(rows[i].wall) / paper)
                      << " (by processor time " << processor_ratio(i, 1) << "), method=volume "
                      << rounded(median(rows[i].wall) / volume) << " (" << processor_ratio(i, 2) << ").\n\n";
    }

    void json_row(const Case &c, const Row &row, double wall, double cpu, double copy, double memory_mib)
    {
        json_ << (first_ ? "" : ",\n") << R"({"width": )" << c.width << R"(, "height": )" << c.height
              << R"(, "planes": )" << c.planes << R"(, "name": ")" << row.name << R"(", "ms": )" << wall
              << R"(, "of_copy": )" << wall / copy << R"(, "cpu_ms": )" << cpu << R"(, "peak_mib": )"
              << memory_mib << R"(, "stages": {)";
        for (size_t i = 0; i < row.stages.size(); i++)
            json_ << (i ? ", " : "") << '"' << row.stages[i].first << "\": " << median(row.stages[i].second);
        json_ << "}}";
        first_ = false;
    }

    std::ofstream markdown_, json_;
    std::ostringstream linearity_;
    bool first_ = true;
};

std::vector<Row> rows_of(const Case &c, const BenchStack &stack, std::vector<Pipeline> &pipelines,
                         std::vector<std::byte> &copy)
{
    const int width = static_cast<int>(c.width), height = static_cast<int>(c.height);
    const int planes = static_cast<int>(c.planes);
    std::vector<Row> rows;
    const auto add = [&](const char *name, unsigned every, const std::function<const StageTimes *()> &work) {
        rows.push_back({name, every, work, {}, {}, {}});
    };
    add("memory copy", 1, [&]() -> const StageTimes * {
        std::memcpy(copy.data(), stack.memory.data(), copy.size());
        return nullptr;
    });
    add("method=paper and AIF", 1, [&] { return pipelines[0].run(); });
    add("method=volume and AIF", 1, [&] { return pipelines[1].run(); });
    if (!c.with_others)
        return rows;
    [[maybe_unused]] static volatile double keep; /* what the others compute, so that they are not left out */
    add("focus measure, plain C++, 1 thread", 3, [=, &stack]() -> const StageTimes * {
        keep = plain_focus_measure(stack.luma, width, height, planes);
        return nullptr;
    });
    add("focus measure, OpenCV", 3, [=, &stack]() -> const StageTimes * {
        keep = opencv_focus_measure(stack.luma, width, height, planes);
        return nullptr;
    });
#ifdef HAVE_XIMGPROC
    add("fast bilateral solver, OpenCV", 5, [&]() -> const StageTimes * {
        opencv_solver(stack);
        return nullptr;
    });
#endif
    return rows;
}

void measure(const Case &c, unsigned rounds, Report &report)
{
    std::cerr << c.width << "x" << c.height << " N=" << c.planes << "\n";
    peak_memory();
    const BenchStack stack(c.width, c.height, c.planes);
    std::vector<std::byte> copy(stack.memory.size());
    std::vector<Pipeline> pipelines;
    pipelines.reserve(2);
    for (const Method method : {Method::Paper, Method::Volume}) {
        pipelines.emplace_back(stack, method);
        pipelines.back().run(); /* compiles */
    }
    std::vector<Row> rows = rows_of(c, stack, pipelines, copy);
    for (unsigned round = 0; round < rounds; round++)
        for (Row &row : rows)
            if (round % row.every == 0)
                row.run();
    report.add(c, rows, peak_memory());
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
        measure(c, option.empty() ? 9 : 5, report);
}
