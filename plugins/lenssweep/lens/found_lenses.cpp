/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "found_lenses.h"

#include "v4l2_lens.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace dff {

namespace {

namespace files = std::filesystem;

/* The first line of a file in sysfs, or nothing. */
std::string line_of(const files::path &path)
{
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    return line;
}

/* In the order of their names. */
std::vector<files::path> entries_of(const files::path &folder)
{
    std::error_code error;
    std::vector<files::path> entries;
    for (files::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        entries.push_back(entry->path());
    std::sort(entries.begin(), entries.end());
    return entries;
}

void add_video_lenses(const Machine &machine, std::vector<FoundLens> &lenses)
{
    for (const files::path &entry : entries_of(files::path(machine.sysfs) / "class/video4linux")) {
        const std::string device = "/dev/" + entry.filename().string();
        const auto range = machine.focus_range(device);
        if (!range)
            continue;
        const bool camera = entry.filename().string().starts_with("video");
        lenses.push_back({camera ? FoundLens::Kind::Camera : FoundLens::Kind::Subdevice, device,
                          line_of(entry / "name"),
                          "focus " + std::to_string(range->first) + " to " + std::to_string(range->second),
                          "v4l2:" + device});
    }
}

/* A port of a USB device has the folder of the interface as its "device", whose parent is the device. */
void add_optotune_drivers(const Machine &machine, std::vector<FoundLens> &lenses)
{
    for (const files::path &entry : entries_of(files::path(machine.sysfs) / "class/tty")) {
        std::error_code error;
        const files::path usb = files::canonical(entry / "device", error).parent_path();
        if (error)
            continue;
        const std::string product = line_of(usb / "product");
        if ((line_of(usb / "manufacturer") + product).find("Optotune") == std::string::npos)
            continue;
        const std::string device = "/dev/" + entry.filename().string();
        lenses.push_back(
            {FoundLens::Kind::Driver, device, product, "Optotune Lens Driver", "optotune:" + device});
    }
}

} // namespace

Machine this_machine()
{
    return {"/sys", v4l2_focus_range};
}

std::vector<FoundLens> find_lenses(const Machine &machine)
{
    std::vector<FoundLens> lenses;
    add_video_lenses(machine, lenses);
    add_optotune_drivers(machine, lenses);
    return lenses;
}

std::string describe(const std::vector<FoundLens> &lenses)
{
    std::string text;
    for (const FoundLens &lens : lenses) {
        text += text.empty() ? "Found on this machine: " : "; ";
        text += lens.device + (lens.name.empty() ? "" : " (" + lens.name + ")") + ": " + lens.what +
                ", lens=" + lens.uri;
    }
    return text.empty() ? "No lens that tells of itself was found on this machine" : text;
}

} // namespace dff
