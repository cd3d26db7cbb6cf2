/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/opencl/kernel_style.h"

#include "engine/engine_error.h"
#include "engine/opencl/kernel_sources.h"
#include "engine/opencl/verdict_file.h"
#include "engine/self_test.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <vector>

namespace dff {

namespace {

/* A driver may end the process, and so may a user who does not wait: twice is the driver. */
constexpr unsigned tries = 2;

constexpr const char *wrong = "computes wrong";

const char *name_of(KernelStyle style)
{
    return style == KernelStyle::Tiles ? "tiles" : "pixels";
}

std::optional<KernelStyle> forced_style()
{
    const char *wish = std::getenv("DFF_KERNELS");
    if (!wish || !*wish)
        return std::nullopt;
    for (const KernelStyle style : {KernelStyle::Tiles, KernelStyle::Pixels})
        if (std::string(wish) == name_of(style))
            return style;
    throw EngineError(EngineError::Kind::NoDevice, std::string("The environment variable DFF_KERNELS is \"") +
                                                       wish +
                                                       "\", and may be tiles or pixels, or not be there");
}

/* Vectors of 32 and 64 are clang's, not OpenCL's: Mesa's llvmpipe calls itself a CPU and ends the process on
 * them. */
std::vector<KernelStyle> styles_for(const cl::Device &device)
{
    const std::string driver = cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>();
    const bool knows_wide_vectors =
        driver.starts_with("Portable Computing Language") || driver.starts_with("Intel(R) OpenCL");
    if ((device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) && knows_wide_vectors)
        return {KernelStyle::Tiles, KernelStyle::Pixels};
    return {KernelStyle::Pixels};
}

std::string driver_of(const cl::Device &device)
{
    const cl::Platform platform(device.getInfo<CL_DEVICE_PLATFORM>());
    return platform.getInfo<CL_PLATFORM_NAME>() + ", " + device.getInfo<CL_DEVICE_VERSION>() + ", driver " +
           device.getInfo<CL_DRIVER_VERSION>();
}

/* All that the verdict depends on: device, driver, kernels and what they are held to. */
std::string key_of(const cl::Device &device)
{
    std::string sources;
    for (const auto &[name, source] : kernel_sources())
        sources.append(source);
    for (const Method method : {Method::Paper, Method::Volume}) {
        const auto results = self_test::stored(method);
        sources.append(results.begin(), results.end());
    }
    return device.getInfo<CL_DEVICE_NAME>() + "\n" + driver_of(device) + "\nkernels " +
           std::to_string(std::hash<std::string>()(sources)) + "\n";
}

EngineError refusal(const cl::Device &device, const VerdictFile &file)
{
    return {
        EngineError::Kind::Failed,
        "The OpenCL driver of " + device.getInfo<CL_DEVICE_NAME>() + " (" + driver_of(device) +
            ") does not compute what it should: it failed the self-test. Install another version of it or "
            "choose another device with the property device. DFF_KERNELS=pixels in the environment uses it "
            "all the same; removing " +
            file.path().string() + " tests it again"};
}

std::string trying(KernelStyle style, unsigned time)
{
    return std::string("trying ") + name_of(style) + ", time " + std::to_string(time);
}

/* How many tries of the style have begun and never ended. */
unsigned begun(const std::string &verdict, KernelStyle style)
{
    for (unsigned time = tries; time > 0; time--)
        if (verdict == trying(style, time))
            return time;
    return 0;
}

/* Goes on where the last process was when it ended. */
std::optional<KernelStyle> try_styles(const std::vector<KernelStyle> &styles, const VerdictFile &file,
                                      const std::function<bool(KernelStyle)> &passes)
{
    const std::string last = file.read();
    const auto first =
        std::ranges::find_if(styles, [&](KernelStyle style) { return begun(last, style) > 0; });
    for (auto style = first == styles.end() ? styles.begin() : first; style != styles.end(); ++style) {
        const unsigned before = begun(last, *style);
        if (before == tries)
            continue;
        file.write(trying(*style, before + 1));
        if (passes(*style))
            return *style;
    }
    return std::nullopt;
}

} // namespace

KernelStyle choose_kernel_style(const Device &device)
{
    return choose_kernel_style(device, [&](KernelStyle style) {
        return self_test::passes(std::make_shared<Device>(device.device(), style, device.works_in_place()));
    });
}

KernelStyle choose_kernel_style(const Device &device, const std::function<bool(KernelStyle)> &passes)
{
    if (const auto forced = forced_style())
        return *forced;
    const VerdictFile file(key_of(device.device()));
    const std::string known = file.read();
    for (const KernelStyle style : {KernelStyle::Tiles, KernelStyle::Pixels})
        if (known == name_of(style))
            return style;
    if (known == wrong)
        throw refusal(device.device(), file);

    const std::optional<KernelStyle> style = try_styles(styles_for(device.device()), file, passes);
    file.write(style ? name_of(*style) : wrong);
    if (!style)
        throw refusal(device.device(), file);
    return *style;
}

} // namespace dff
