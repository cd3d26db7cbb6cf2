/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "camera_setup.h"

#include "camera_control.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace dff {

namespace {

std::string listed(const std::vector<std::string> &values)
{
    std::string text;
    for (const std::string &value : values)
        text.append(text.empty() ? "" : ", ").append(value);
    return text.empty() ? "none" : text;
}

bool offers(CameraControl &camera, const std::string &feature, const std::string &value)
{
    if (!camera.has(feature))
        return false;
    const auto values = camera.enumeration_values(feature);
    return std::find(values.begin(), values.end(), value) != values.end();
}

void choose_if_offered(CameraControl &camera, const std::string &feature, const std::string &value)
{
    if (offers(camera, feature, value))
        camera.set_enumeration(feature, value);
}

/* Triggers of another kind than FrameStart would hold every frame back. */
void switch_other_triggers_off(CameraControl &camera)
{
    if (!camera.has("TriggerSelector"))
        return;
    for (const std::string &trigger : camera.enumeration_values("TriggerSelector")) {
        if (trigger == "FrameStart")
            continue;
        camera.set_enumeration("TriggerSelector", trigger);
        choose_if_offered(camera, "TriggerMode", "Off");
    }
    choose_if_offered(camera, "TriggerSelector", "FrameStart");
}

void choose_source(CameraControl &camera, const std::string &source)
{
    if (!camera.has("TriggerSource"))
        throw CameraError("this camera cannot be triggered (it has no TriggerSource): use trigger=free-run");
    if (!offers(camera, "TriggerSource", source))
        throw CameraError("this camera has no trigger source " + source + "; it has " +
                          listed(camera.enumeration_values("TriggerSource")) +
                          ": choose one with trigger-source, or another trigger");
    camera.set_enumeration("TriggerSource", source);
}

template <typename Value> void check_range(const char *what, double value, std::pair<Value, Value> range)
{
    if (value >= static_cast<double>(range.first) && value <= static_cast<double>(range.second))
        return;
    std::ostringstream text;
    text << what << " " << value << " is out of the camera's range, " << range.first << " to "
         << range.second;
    throw CameraError(text.str());
}

void set_number(CameraControl &camera, const std::string &feature, const char *what, double value)
{
    if (camera.is_integer(feature)) {
        check_range(what, value, camera.integer_range(feature));
        camera.set_integer(feature, std::llround(value));
        return;
    }
    check_range(what, value, camera.float_range(feature));
    camera.set_float(feature, value);
}

} // namespace

void set_up_trigger(CameraControl &camera, const TriggerSetup &setup)
{
    choose_if_offered(camera, "AcquisitionMode", "Continuous");
    choose_if_offered(camera, "ExposureMode", "Timed");
    choose_if_offered(camera, "ExposureAuto", "Off");
    switch_other_triggers_off(camera);
    if (setup.kind == TriggerKind::FreeRun) {
        choose_if_offered(camera, "TriggerMode", "Off");
        set_frame_rate(camera, setup.frame_rate);
        return;
    }
    choose_source(camera, setup.kind == TriggerKind::Software ? "Software" : setup.source);
    if (setup.kind == TriggerKind::Line)
        choose_if_offered(camera, "TriggerActivation", "RisingEdge");
    choose_if_offered(camera, "TriggerOverlap", "ReadOut");
    if (camera.has("AcquisitionFrameRateEnable"))
        camera.set_boolean("AcquisitionFrameRateEnable", false);
    camera.set_enumeration("TriggerMode", "On");
}

void set_frame_rate(CameraControl &camera, double frame_rate)
{
    if (camera.has("AcquisitionFrameRateEnable"))
        camera.set_boolean("AcquisitionFrameRateEnable", true);
    for (const char *feature : {"AcquisitionFrameRate", "AcquisitionFrameRateAbs"}) {
        if (camera.has(feature)) {
            set_number(camera, feature, "the frame rate (planes times rate)", frame_rate);
            return;
        }
    }
}

void set_exposure(CameraControl &camera, double exposure_us)
{
    for (const char *feature : {"ExposureTime", "ExposureTimeAbs"}) {
        if (camera.has(feature)) {
            set_number(camera, feature, "an exposure in us of", exposure_us);
            return;
        }
    }
}

void set_gain(CameraControl &camera, double gain)
{
    choose_if_offered(camera, "GainAuto", "Off");
    for (const char *feature : {"Gain", "GainRaw"}) {
        if (camera.has(feature)) {
            set_number(camera, feature, "a gain of", gain);
            return;
        }
    }
    throw CameraError("this camera has no gain to set");
}

bool trigger_armed(CameraControl &camera)
{
    if (camera.has("TriggerArmed"))
        return camera.get_boolean("TriggerArmed");
    if (!offers(camera, "AcquisitionStatusSelector", "FrameTriggerWait"))
        return true;
    camera.set_enumeration("AcquisitionStatusSelector", "FrameTriggerWait");
    return camera.get_boolean("AcquisitionStatus");
}

} // namespace dff
