/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "aravis_camera.h"

#include "camera_control.h"
#include "camera_list.h"

namespace dff {

namespace {

ObjectRef<ArvCamera> open_simulated(const std::string &serial)
{
    CallError error;
    const ObjectRef<ArvDevice> device(arv_fake_device_new(serial.c_str(), error.out()));
    error.check<CameraError>("the simulated camera cannot be had");
    ArvCamera *camera = arv_camera_new_with_device(device.get(), error.out());
    error.check<CameraError>("the simulated camera cannot be had");
    return ObjectRef<ArvCamera>(camera);
}

ObjectRef<ArvCamera> open_camera(const std::string &name)
{
    const std::string simulated = "Fake_";
    if (name.starts_with(simulated) && name.size() > simulated.size())
        return open_simulated(name.substr(simulated.size()));
    const std::string id = find_camera(name);
    CallError error;
    ArvCamera *camera = arv_camera_new(id.c_str(), error.out());
    error.check<CameraError>("the camera " + id + " cannot be opened (does another program use it?)");
    ObjectRef<ArvCamera> opened(camera);
    ArvDevice *device = arv_camera_get_device(camera);
    if (ARV_IS_GV_DEVICE(device) && !arv_gv_device_is_controller(ARV_GV_DEVICE(device)))
        throw CameraError("another program controls the camera " + id +
                          ". End it; one that crashed holds the camera for some seconds more");
    return opened;
}

std::vector<std::string> strings(const char **names, guint count)
{
    std::vector<std::string> result(names, names + (names ? count : 0));
    g_free(names); /* the strings are Aravis's */
    return result;
}

} // namespace

AravisCamera::AravisCamera(const std::string &name, std::function<void()> on_gone)
    : camera_(open_camera(name)), on_gone_(std::move(on_gone))
{
    const auto lost = +[](ArvDevice *, AravisCamera *self) {
        self->gone_ = true;
        self->on_gone_();
    };
    gone_signal_ =
        g_signal_connect(arv_camera_get_device(camera_.get()), "control-lost", G_CALLBACK(lost), this);
}

/* The thread that tells that the camera is gone holds the device meanwhile. Were its reference the last, the
 * device would end in that thread, and wait there for the end of the same thread. */
AravisCamera::~AravisCamera()
{
    ArvDevice *device = arv_camera_get_device(camera_.get());
    g_signal_handler_disconnect(device, gone_signal_);
    for (int i = 0; i < 1000 && g_atomic_int_get(&G_OBJECT(device)->ref_count) > 1; i++)
        g_usleep(1000);
}

/* Aravis asks several times before it says that nobody answers. */
void AravisCamera::check(const CallError &error, const std::string &what)
{
    if (error.is(ARV_DEVICE_ERROR, ARV_DEVICE_ERROR_TIMEOUT) ||
        error.is(ARV_DEVICE_ERROR, ARV_DEVICE_ERROR_NOT_CONNECTED)) {
        gone_ = true;
        throw CameraError(camera_gone);
    }
    error.check<CameraError>("the camera refuses " + what);
}

/* One call of Aravis's at a time; what it says of an error becomes an exception. */
template <typename Call> auto AravisCamera::call(const std::string &what, Call call)
{
    const std::lock_guard lock(mutex_);
    CallError error;
    if constexpr (std::is_void_v<decltype(call(camera_.get(), error.out()))>) {
        call(camera_.get(), error.out());
        check(error, what);
    } else {
        auto result = call(camera_.get(), error.out());
        check(error, what);
        return result;
    }
}

std::string AravisCamera::title() const
{
    std::string title;
    for (auto *part :
         {arv_camera_get_vendor_name, arv_camera_get_model_name, arv_camera_get_device_serial_number}) {
        CallError error;
        const char *text = part(camera_.get(), error.out());
        if (text && *text)
            title.append(title.empty() ? "" : " ").append(text);
    }
    return title;
}

FrameNumbering AravisCamera::numbering()
{
    if (arv_camera_is_uv_device(camera_.get()))
        return FrameNumbering::Usb64;
    const std::string mode = "GevGVSPExtendedIDMode";
    const bool extended = has(mode) && get_enumeration(mode) == "On";
    return extended ? FrameNumbering::GigE64 : FrameNumbering::GigE16;
}

double AravisCamera::told_link_bits()
{
    if (has("GevLinkSpeed"))
        return static_cast<double>(get_integer("GevLinkSpeed")) * 1e6;
    if (has("DeviceLinkSpeed"))
        return static_cast<double>(get_integer("DeviceLinkSpeed")) * 8;
    return 0;
}

double AravisCamera::link_bits()
{
    const double told = told_link_bits();
    const double usual = arv_camera_is_gv_device(camera_.get()) ? 1e9 : 0;
    return told > 0 ? told : usual;
}

unsigned AravisCamera::packet()
{
    if (!arv_camera_is_gv_device(camera_.get()))
        return 0;
    return call("its packet size", arv_camera_gv_get_packet_size);
}

bool AravisCamera::ignores_triggers() const
{
    return ARV_IS_FAKE_DEVICE(arv_camera_get_device(handle()));
}

bool AravisCamera::has_ptp()
{
    for (const char *feature : {"PtpEnable", "GevIEEE1588"})
        if (has(feature))
            return get_boolean(feature);
    return false;
}

std::vector<std::string> AravisCamera::pixel_formats()
{
    return call("its list of pixel formats", [](ArvCamera *camera, GError **error) {
        guint count = 0;
        const char **names = arv_camera_dup_available_pixel_formats_as_strings(camera, &count, error);
        return strings(names, count);
    });
}

std::string AravisCamera::pixel_format()
{
    return call("its pixel format", [](ArvCamera *camera, GError **error) {
        const char *name = arv_camera_get_pixel_format_as_string(camera, error);
        return std::string(name ? name : "");
    });
}

void AravisCamera::set_pixel_format(const std::string &format)
{
    call("the pixel format " + format, [&](ArvCamera *camera, GError **error) {
        arv_camera_set_pixel_format_from_string(camera, format.c_str(), error);
    });
}

CameraRegion AravisCamera::region()
{
    return call("its region", [](ArvCamera *camera, GError **error) {
        CameraRegion region;
        arv_camera_get_region(camera, &region.x, &region.y, &region.width, &region.height, error);
        return region;
    });
}

void AravisCamera::set_region(const CameraRegion &region)
{
    const std::string what =
        "a picture of " + std::to_string(region.width) + "x" + std::to_string(region.height);
    call(what, [&](ArvCamera *camera, GError **error) {
        arv_camera_set_region(camera, region.x, region.y, region.width, region.height, error);
    });
}

CameraExtent AravisCamera::widths()
{
    return call("its widths", [](ArvCamera *camera, GError **error) {
        CameraExtent extent{1, 1, 1};
        arv_camera_get_width_bounds(camera, &extent.least, &extent.most, error);
        if (!*error)
            extent.step = arv_camera_get_width_increment(camera, error);
        return extent;
    });
}

CameraExtent AravisCamera::heights()
{
    return call("its heights", [](ArvCamera *camera, GError **error) {
        CameraExtent extent{1, 1, 1};
        arv_camera_get_height_bounds(camera, &extent.least, &extent.most, error);
        if (!*error)
            extent.step = arv_camera_get_height_increment(camera, error);
        return extent;
    });
}

std::size_t AravisCamera::payload()
{
    return call("its payload", arv_camera_get_payload);
}

void AravisCamera::start_acquisition()
{
    call("to start", arv_camera_start_acquisition);
}

void AravisCamera::stop_acquisition() noexcept
{
    const std::lock_guard lock(mutex_);
    CallError ignored; /* a camera that is gone does not matter any more */
    if (!gone_)
        arv_camera_stop_acquisition(camera_.get(), ignored.out());
}

bool AravisCamera::has(const std::string &feature)
{
    const std::lock_guard lock(mutex_);
    CallError error;
    return arv_camera_is_feature_available(camera_.get(), feature.c_str(), error.out()) && !error.failed();
}

bool AravisCamera::is_integer(const std::string &feature)
{
    const std::lock_guard lock(mutex_);
    ArvGcNode *node = arv_device_get_feature(arv_camera_get_device(camera_.get()), feature.c_str());
    return ARV_IS_GC_INTEGER(node) && !ARV_IS_GC_FLOAT(node);
}

bool AravisCamera::is_command(const std::string &feature)
{
    if (!has(feature))
        return false;
    const std::lock_guard lock(mutex_);
    return ARV_IS_GC_COMMAND(arv_device_get_feature(arv_camera_get_device(camera_.get()), feature.c_str()));
}

std::string AravisCamera::unit(const std::string &feature)
{
    const std::lock_guard lock(mutex_);
    ArvGcNode *node = arv_device_get_feature(arv_camera_get_device(camera_.get()), feature.c_str());
    const char *unit = nullptr;
    if (ARV_IS_GC_FLOAT(node))
        unit = arv_gc_float_get_unit(ARV_GC_FLOAT(node));
    else if (ARV_IS_GC_INTEGER(node))
        unit = arv_gc_integer_get_unit(ARV_GC_INTEGER(node));
    return unit ? unit : "";
}

double AravisCamera::get_float(const std::string &feature)
{
    return call(feature, [&](ArvCamera *camera, GError **error) {
        return arv_camera_get_float(camera, feature.c_str(), error);
    });
}

void AravisCamera::set_float(const std::string &feature, double value)
{
    call(feature + "=" + std::to_string(value), [&](ArvCamera *camera, GError **error) {
        arv_camera_set_float(camera, feature.c_str(), value, error);
    });
}

std::pair<double, double> AravisCamera::float_range(const std::string &feature)
{
    return call("the range of " + feature, [&](ArvCamera *camera, GError **error) {
        std::pair<double, double> range;
        arv_camera_get_float_bounds(camera, feature.c_str(), &range.first, &range.second, error);
        return range;
    });
}

std::int64_t AravisCamera::get_integer(const std::string &feature)
{
    return call(feature, [&](ArvCamera *camera, GError **error) {
        return arv_camera_get_integer(camera, feature.c_str(), error);
    });
}

void AravisCamera::set_integer(const std::string &feature, std::int64_t value)
{
    call(feature + "=" + std::to_string(value), [&](ArvCamera *camera, GError **error) {
        arv_camera_set_integer(camera, feature.c_str(), value, error);
    });
}

std::pair<std::int64_t, std::int64_t> AravisCamera::integer_range(const std::string &feature)
{
    return call("the range of " + feature, [&](ArvCamera *camera, GError **error) {
        gint64 least = 0;
        gint64 most = 0;
        arv_camera_get_integer_bounds(camera, feature.c_str(), &least, &most, error);
        return std::pair<std::int64_t, std::int64_t>(least, most);
    });
}

std::string AravisCamera::get_enumeration(const std::string &feature)
{
    return call(feature, [&](ArvCamera *camera, GError **error) {
        const char *value = arv_camera_get_string(camera, feature.c_str(), error);
        return std::string(value ? value : "");
    });
}

void AravisCamera::set_enumeration(const std::string &feature, const std::string &value)
{
    call(feature + "=" + value, [&](ArvCamera *camera, GError **error) {
        arv_camera_set_string(camera, feature.c_str(), value.c_str(), error);
    });
}

std::vector<std::string> AravisCamera::enumeration_values(const std::string &feature)
{
    return call("the list of " + feature, [&](ArvCamera *camera, GError **error) {
        guint count = 0;
        const char **names =
            arv_camera_dup_available_enumerations_as_strings(camera, feature.c_str(), &count, error);
        return strings(names, count);
    });
}

void AravisCamera::execute(const std::string &command)
{
    call(command, [&](ArvCamera *camera, GError **error) {
        arv_camera_execute_command(camera, command.c_str(), error);
    });
}

bool AravisCamera::get_boolean(const std::string &feature)
{
    return call(feature, [&](ArvCamera *camera, GError **error) {
        return arv_camera_get_boolean(camera, feature.c_str(), error) != FALSE;
    });
}

void AravisCamera::set_boolean(const std::string &feature, bool value)
{
    call(feature, [&](ArvCamera *camera, GError **error) {
        arv_camera_set_boolean(camera, feature.c_str(), value, error);
    });
}

void AravisCamera::set_features(const std::string &text)
{
    call("features=" + text, [&](ArvCamera *camera, GError **error) {
        arv_device_set_features_from_string(arv_camera_get_device(camera), text.c_str(), error);
    });
}

} // namespace dff
