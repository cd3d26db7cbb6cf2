/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "bench_camera.h"

#include "frame_stamp.h"
#include "registers.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <stdexcept>

namespace dff {

namespace {

/* The control channel is deaf for so long. */
constexpr uint64_t longest_wait_ns = 5'000'000;
constexpr auto register_period = std::chrono::milliseconds(1);
constexpr double reference_exposure_us = 6000.0;

/* ArvFakeCamera's register is not 0 while it is acquiring. The client writes 1; we write 2 once we listen to
 * triggers, and genicam.xml says so in TriggerArmed. */
enum Acquisition : uint32_t { acquisition_stopped = 0, acquisition_wanted = 1, acquisition_runs = 2 };

void idle(ArvBuffer *, void *, guint32, guint32, ArvPixelFormat)
{
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

} // namespace

BenchCamera::BenchCamera(const BenchCameraSettings &settings, PlanePictures pictures, Report &report)
    : settings_(settings), pictures_(std::move(pictures)), report_(report),
      sensor_(settings.sensor, settings.faults, report),
      device_(arv_gv_fake_camera_new_full(settings.interface.c_str(), settings.serial.c_str(),
                                          settings.genicam.c_str())),
      camera_(arv_gv_fake_camera_get_fake_camera(device_.get()))
{
    if (!arv_gv_fake_camera_is_running(device_.get()))
        throw std::runtime_error("the network interface " + settings.interface +
                                 " cannot be used; inside a network namespace: ip link set lo up");
    describe();
    arv_fake_camera_set_fill_pattern(camera_, &BenchCamera::fill, this);
    thread_ = std::jthread([this](const std::stop_token &stop) { watch_registers(stop); });
}

BenchCamera::~BenchCamera()
{
    thread_.request_stop();
    thread_.join();
    /* Returns once fill() does not run, nor will; what Aravis sends in its place until its thread has ended
     * is thrown away, since idle() takes longer than the next line. */
    arv_fake_camera_set_fill_pattern(camera_, idle, nullptr);
    set_sending(false);
    device_.reset();
    sensor_.stop_acquisition();
}

void BenchCamera::describe()
{
    const cv::Size size = pictures_.size();
    write_text(register_vendor, "gst-plugins-dff");
    write_text(register_model, "bench-camera");
    write_text(register_version, "1");
    write(ARV_FAKE_CAMERA_REGISTER_SENSOR_WIDTH, static_cast<uint32_t>(size.width));
    write(ARV_FAKE_CAMERA_REGISTER_SENSOR_HEIGHT, static_cast<uint32_t>(size.height));
    write(ARV_FAKE_CAMERA_REGISTER_WIDTH, static_cast<uint32_t>(size.width));
    write(ARV_FAKE_CAMERA_REGISTER_HEIGHT, static_cast<uint32_t>(size.height));
    /* As fast as it can: our sensor sets the pace. */
    write(ARV_FAKE_CAMERA_REGISTER_TRIGGER_MODE, 0);
    write(ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US, 1);
    write_float(register_frame_rate, 25.0);
    write(register_frame_rate_enable, 1);
    write_float(register_exposure_time, reference_exposure_us);
    write_float(register_focal_power, settings_.plan.near());
    write_float(register_settled_power, settings_.plan.near());
    wanted_power_ = read(register_focal_power);
}

uint32_t BenchCamera::read(uint32_t address) const
{
    guint32 value = 0;
    arv_fake_camera_read_register(camera_, address, &value);
    return value;
}

double BenchCamera::read_float(uint32_t address) const
{
    return static_cast<double>(std::bit_cast<float>(read(address)));
}

void BenchCamera::write(uint32_t address, uint32_t value)
{
    arv_fake_camera_write_register(camera_, address, value);
}

void BenchCamera::write_float(uint32_t address, double value)
{
    write(address, std::bit_cast<uint32_t>(static_cast<float>(value)));
}

void BenchCamera::write_text(uint32_t address, const std::string &text)
{
    std::string padded = text;
    padded.resize(name_length);
    arv_fake_camera_write_memory(camera_, address, name_length, padded.data());
}

void BenchCamera::trigger(const Trigger &trigger)
{
    if (!settings_.register_lens)
        lens_.jump({trigger.sweep, trigger.plane});
    report_.triggers++;
    if (read(register_trigger_mode) == 1 && read(register_trigger_source) == source_line0)
        sensor_.expose(trigger.time_ns, lens_.position());
    else
        report_.unheard++;
}

void BenchCamera::watch_registers(const std::stop_token &stop)
{
    while (!stop.stop_requested()) {
        watch_acquisition();
        watch_exposure();
        watch_lens();
        watch_software_trigger();
        run_free();
        std::this_thread::sleep_for(register_period);
    }
}

void BenchCamera::watch_acquisition()
{
    if (read(ARV_FAKE_CAMERA_REGISTER_ACQUISITION) == acquisition_stopped ||
        arv_fake_camera_get_control_channel_privilege(camera_) == 0)
        sensor_.stop_acquisition();
}

void BenchCamera::watch_exposure()
{
    sensor_.set({static_cast<uint64_t>(read_float(register_exposure_time) * 1e3),
                 read(register_trigger_overlap) == 1});
}

void BenchCamera::watch_lens()
{
    if (!settings_.register_lens)
        return;
    const uint32_t power = read(register_focal_power);
    if (power != wanted_power_) {
        wanted_power_ = power;
        settled_at_ns_ = monotonic_ns() + settings_.settle_ns;
    }
    if (settled_at_ns_ == 0 || monotonic_ns() < settled_at_ns_)
        return;
    settled_at_ns_ = 0;
    lens_.focus(settings_.plan, static_cast<double>(std::bit_cast<float>(power)));
    report_.focus_moves++;
    write(register_settled_power, power);
}

void BenchCamera::watch_software_trigger()
{
    if (read(register_trigger_software) == 0)
        return;
    write(register_trigger_software, 0);
    report_.software++;
    if (read(register_trigger_mode) == 1 && read(register_trigger_source) == source_software)
        sensor_.expose(monotonic_ns(), lens_.position());
    else
        report_.unheard++;
}

void BenchCamera::run_free()
{
    const uint64_t now = monotonic_ns();
    if (read(register_trigger_mode) == 1 || read(ARV_FAKE_CAMERA_REGISTER_ACQUISITION) != acquisition_runs) {
        next_free_ns_ = now;
        return;
    }
    if (now < next_free_ns_)
        return;
    const double exposure_period =
        read_float(register_exposure_time) * 1e3 + static_cast<double>(settings_.sensor.readout_ns);
    const double wanted_period =
        read(register_frame_rate_enable) == 1 ? 1e9 / read_float(register_frame_rate) : 0.0;
    sensor_.expose(next_free_ns_, lens_.position());
    next_free_ns_ += static_cast<uint64_t>(std::max(exposure_period, wanted_period));
}

void BenchCamera::set_sending(bool sending)
{
    g_object_set(device_.get(), "gvsp-lost-ratio", sending ? 0.0 : 1.0, nullptr);
}

void BenchCamera::fill(ArvBuffer *buffer, void *self, guint32, guint32, ArvPixelFormat)
{
    static_cast<BenchCamera *>(self)->fill(buffer);
}

void BenchCamera::fill(ArvBuffer *buffer)
{
    if (read(ARV_FAKE_CAMERA_REGISTER_ACQUISITION) == acquisition_wanted) {
        watch_exposure();
        sensor_.start_acquisition();
        write(ARV_FAKE_CAMERA_REGISTER_ACQUISITION, acquisition_runs);
    }
    const std::optional<Exposure> frame = sensor_.next_frame(longest_wait_ns);
    set_sending(frame.has_value());
    if (!frame)
        return;

    const double gain = std::pow(10.0, read_float(register_gain) / 20.0);
    pictures_.set_format({arv_buffer_get_image_pixel_format(buffer),
                          {arv_buffer_get_image_x(buffer), arv_buffer_get_image_y(buffer),
                           arv_buffer_get_image_width(buffer), arv_buffer_get_image_height(buffer)},
                          gain * read_float(register_exposure_time) / reference_exposure_us});
    /* The size that the buffer itself names is that of what was received, which is nothing yet. */
    const std::span<uint8_t> pixels(
        static_cast<uint8_t *>(const_cast<void *>(arv_buffer_get_data(buffer, nullptr))),
        arv_fake_camera_get_payload(camera_));
    pictures_.copy(frame->lens.sweep, frame->lens.plane, pixels);
    if (settings_.stamp)
        pictures_.stamp(
            frame_stamp(static_cast<uint32_t>(frame->lens.sweep), static_cast<uint8_t>(frame->lens.plane)),
            pixels);
    arv_buffer_set_frame_id(buffer, frame->frame_id);
    arv_buffer_set_timestamp(buffer, settings_.clock.at(frame->start_ns));
}

} // namespace dff
