/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "camera_clock.h"
#include "plane_pictures.h"
#include "report.h"
#include "sensor.h"
#include "sequencer.h"
#include "simulated_lens.h"

#include <arv.h>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>

namespace dff {

struct BenchCameraSettings {
    std::string interface = "lo";
    std::string serial = "BENCH";
    std::string genicam; /* path of the XML file */
    SweepPlan plan = SweepPlan::even(6, 5.0, 0.0);
    bool register_lens = false; /* FocalPower moves the lens, not the sequencer */
    uint64_t settle_ns = 2'000'000;
    bool stamp = false;
    CameraClock clock;
    SensorTraits sensor;
    FaultSettings faults;
};

/* The GigE Vision camera: Aravis' fake camera, made to think that it runs free and as fast as it can. It
 * blocks in the callback that fills its buffer until our sensor has a frame; where none comes, what it sends
 * is thrown away. */
class BenchCamera {
public:
    /* Throws std::runtime_error where the network interface or the port cannot be had. */
    BenchCamera(const BenchCameraSettings &settings, PlanePictures pictures, Report &report);
    ~BenchCamera();
    BenchCamera(const BenchCamera &) = delete;
    BenchCamera &operator=(const BenchCamera &) = delete;

    /* An edge on Line0. */
    void trigger(const Trigger &trigger);

private:
    struct Unref {
        void operator()(gpointer object) const { g_object_unref(object); }
    };

    static void fill(ArvBuffer *buffer, void *self, guint32 exposure, guint32 gain, ArvPixelFormat pixels);
    void fill(ArvBuffer *buffer);
    void set_sending(bool sending);

    void describe();
    void watch_registers(const std::stop_token &stop);
    void watch_acquisition();
    void watch_exposure();
    void watch_lens();
    void watch_software_trigger();
    void run_free();

    uint32_t read(uint32_t address) const;
    double read_float(uint32_t address) const;
    void write(uint32_t address, uint32_t value);
    void write_float(uint32_t address, double value);
    void write_text(uint32_t address, const std::string &text);

    BenchCameraSettings settings_;
    PlanePictures pictures_; /* of the control thread */
    Report &report_;
    Sensor sensor_;
    SimulatedLens lens_;
    uint64_t settled_at_ns_ = 0; /* of the register thread; 0: the lens stands still */
    uint32_t wanted_power_ = 0;
    uint64_t next_free_ns_ = 0;
    std::unique_ptr<ArvGvFakeCamera, Unref> device_;
    ArvFakeCamera *camera_; /* belongs to device_ */
    std::jthread thread_;
};

} // namespace dff
