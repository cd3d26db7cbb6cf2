/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

/* An Optotune Lens Driver 4i with a lens of -1.5 to 3.5 dioptres, on a pseudo-terminal: it speaks the
 * protocol as its manual has it, and does what cables and warm lenses do, when it is told to. */
class FakeOptotune {
public:
    explicit FakeOptotune(char firmware_type = 'F');
    ~FakeOptotune();
    FakeOptotune(const FakeOptotune &) = delete;
    FakeOptotune &operator=(const FakeOptotune &) = delete;

    /* Of the port: /dev/pts/N. */
    const std::string &device() const { return device_; }

    /* Every `n`th byte that comes in, or goes out, is lost; 0: none is. */
    void lose_bytes(unsigned n);

    /* Answers come so much later. */
    void answer_late(std::chrono::milliseconds delay);

    void set_temperature(double degrees);

    /* Focal powers cannot be held: the lens has no memory, or is too hot. */
    void refuse_focal_power();

    /* As one that was just plugged in: no focal power is held before it is told between which temperatures.
     */
    void forget_temperature_limits();

    /* Currents and frequency of its signal are told in an answer with three letters, as some firmware does.
     */
    void answer_with_three_letters();

    /* The current going to and fro, on straight lines; at `since_ns` (CLOCK_MONOTONIC) it was half way up. */
    struct Triangle {
        double lower; /* mA */
        double upper;
        double hertz;
        std::uint64_t since_ns;
    };
    /* Nothing but in that mode, and once it was told all of them. */
    std::optional<Triangle> triangle();

    /* The port is gone, for good. */
    void unplug();

    /* What the lens was told, oldest first: dioptres or mA, as texts such as "2.5 D" and "-10 mA". */
    std::vector<std::string> moves();

    /* Command, if it is whole, that it did not understand. */
    unsigned faults();

private:
    void serve(const std::stop_token &stop);
    bool take_command();
    void do_command(const std::string &command);
    void answer(std::string letters, const std::string &data = {});
    void send(const std::string &bytes);
    void note(double value, const char *unit);
    void do_signal_command(const std::string &command);

    std::mutex mutex_;
    std::string device_;
    int master_;
    int slave_; /* kept open, so that the master is never without one */
    char firmware_type_;
    std::string input_;
    std::vector<std::string> moves_;
    unsigned faults_ = 0;
    unsigned lost_every_ = 0;
    unsigned bytes_ = 0;
    std::chrono::milliseconds delay_{0};
    double temperature_ = 25;
    bool refuses_ = false;
    char mode_ = 'D';
    int focal_power_code_ = 0;
    int current_code_ = 0;
    bool knows_limits_ = true;
    bool three_letters_ = false;
    std::map<char, std::uint32_t> signal_; /* by letter: 'L', 'U', 'F' */
    std::uint64_t signal_since_ns_ = 0;
    std::jthread server_;
};
