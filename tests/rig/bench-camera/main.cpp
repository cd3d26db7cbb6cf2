/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */

/* A GigE Vision camera on the loopback interface with a swept liquid lens before it, all simulated but the
 * packets. tests/rig/README.md says how to use it. */
#include "bench_camera.h"
#include "line_server.h"
#include "options.h"
#include "report.h"
#include "sequencer.h"

#include <csignal>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <unistd.h>

using namespace dff;

namespace {

/* Blocks the signals that end us, in this thread and in all it starts, so that one can wait for them. */
sigset_t block_ending_signals()
{
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    return signals;
}

/* For a signal, or the end of the process that started this one: a test that is killed leaves no camera
 * behind. */
void wait_for_end(const sigset_t &signals)
{
    const pid_t parent = getppid();
    const timespec interval{0, 500'000'000};
    while (sigtimedwait(&signals, nullptr, &interval) < 0 && getppid() == parent) {
    }
}

void write_truth(const std::string &path, const SweptCamera &camera)
{
    if (!path.empty() && !cv::imwrite(path, camera.depth_map(0)))
        throw std::runtime_error("cannot write " + path);
}

void serve(const Options &options, const sigset_t &signals, Report &report)
{
    const SweptCamera simulation = options.scene.camera(options.camera.plan, options.size, {});
    write_truth(options.truth, simulation);
    BenchCamera camera(options.camera, PlanePictures(simulation), report);

    FaultSettings sync_fault;
    sync_fault.lose = options.lose_sync;
    sync_fault.seed = options.camera.faults.seed;
    FaultPlan sync_faults(sync_fault);
    std::optional<LineServer> sync;
    if (!options.sync_line.empty())
        sync.emplace(options.sync_line, [](bool) {});
    Sequencer sequencer(options.sequencer, {[&](const Trigger &trigger) { camera.trigger(trigger); },
                                            [&](uint64_t time_ns) {
                                                report.syncs++;
                                                if (sync_faults.next().lose)
                                                    report.syncs_lost++;
                                                else if (sync)
                                                    sync->send(true, time_ns);
                                            }});
    std::optional<LineServer> run;
    if (options.run_line.empty())
        sequencer.set_run(true);
    else
        run.emplace(options.run_line, [&](bool level) { sequencer.set_run(level); });

    std::cout << "ready" << std::endl;
    wait_for_end(signals);
}

} // namespace

int main(int argc, char **argv)
try {
    const sigset_t signals = block_ending_signals();
    Report report;
    serve(parse_options(argc, argv), signals, report);
    std::cout << report.json() << std::endl;
    return 0;
} catch (const std::exception &error) {
    std::cerr << "bench-camera: " << error.what() << std::endl;
    return 1;
}
