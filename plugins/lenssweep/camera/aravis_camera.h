/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "camera_control.h"
#include "camera_frame.h"

#include <arv.h>
#include <atomic>
#include <functional>
#include <glib-object.h>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace dff {

struct ObjectUnref {
    void operator()(gpointer object) const { g_object_unref(object); }
};

template <typename Object> using ObjectRef = std::unique_ptr<Object, ObjectUnref>;

/* Takes the GError of a call: some_call(..., error.out()); error.check("what failed"). */
class CallError {
public:
    CallError() = default;
    CallError(const CallError &) = delete;
    CallError &operator=(const CallError &) = delete;
    ~CallError() { g_clear_error(&error_); }

    GError **out() { return &error_; }
    bool failed() const { return error_ != nullptr; }
    bool is(GQuark domain, int code) const { return g_error_matches(error_, domain, code) != FALSE; }

    /* Throws an Error that begins with `what`. */
    template <typename Error = std::runtime_error> void check(const std::string &what) const
    {
        if (error_)
            throw Error(what + ": " + error_->message);
    }

private:
    GError *error_ = nullptr;
};

/* A rectangle of the sensor's. */
struct CameraRegion {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
};

/* What widths or heights a camera can have. */
struct CameraExtent {
    int least;
    int most;
    int step;
};

/* A GenICam camera by Aravis. Calls may come from any thread. A call on a camera that is gone takes until
 * Aravis has tried a few times, some seconds, and then throws. */
class AravisCamera : public CameraControl {
public:
    /* Opens a camera by its id, serial number, MAC or IP address, as `arv-tool-0.8` lists them; an empty name
     * is the first one found, "Fake_1" one that Aravis simulates. Throws CameraError, with a list of the
     * cameras found. `on_gone` is called, from a thread of Aravis's, when the camera does not answer any
     * more. */
    explicit AravisCamera(
        const std::string &name, std::function<void()> on_gone = [] {});
    ~AravisCamera() override;

    bool gone() const { return gone_; }

    ArvCamera *handle() const { return camera_.get(); }

    /* "vendor model serial" */
    std::string title() const;
    FrameNumbering numbering();

    /* Bits a second of its link; 0 if it is not known. GigE Vision without a word on it: 1 Gbit/s. */
    double link_bits();

    /* What the camera itself says of that; 0 if it does not. */
    double told_link_bits();

    /* Bytes of an IP packet; 0 if it is no GigE Vision camera. */
    unsigned packet();

    /* Whether its clock follows PTP. */
    bool has_ptp();

    /* Whether it is the camera that Aravis simulates in this process, which sends frames at its own pace
     * whatever its trigger is set to. */
    bool ignores_triggers() const;

    std::vector<std::string> pixel_formats();
    std::string pixel_format();
    void set_pixel_format(const std::string &format);
    CameraRegion region();
    void set_region(const CameraRegion &region);
    CameraExtent widths();
    CameraExtent heights();
    std::size_t payload();

    void start_acquisition();
    void stop_acquisition() noexcept;

    bool has(const std::string &feature) override;
    bool is_integer(const std::string &feature) override;
    bool is_command(const std::string &feature) override;
    std::string unit(const std::string &feature) override;
    double get_float(const std::string &feature) override;
    void set_float(const std::string &feature, double value) override;
    std::pair<double, double> float_range(const std::string &feature) override;
    std::int64_t get_integer(const std::string &feature) override;
    void set_integer(const std::string &feature, std::int64_t value) override;
    std::pair<std::int64_t, std::int64_t> integer_range(const std::string &feature) override;
    std::string get_enumeration(const std::string &feature) override;
    void set_enumeration(const std::string &feature, const std::string &value) override;
    std::vector<std::string> enumeration_values(const std::string &feature) override;
    void execute(const std::string &command) override;
    bool get_boolean(const std::string &feature) override;
    void set_boolean(const std::string &feature, bool value) override;
    void set_features(const std::string &text) override;

private:
    template <typename Call> auto call(const std::string &what, Call call);
    void check(const CallError &error, const std::string &what);

    /* Guards Aravis's tree of features, whose nodes are not made for threads. Nothing is locked within. */
    std::mutex mutex_;
    ObjectRef<ArvCamera> camera_;
    std::atomic<bool> gone_ = false;
    const std::function<void()> on_gone_;
    gulong gone_signal_ = 0;
};

} // namespace dff
