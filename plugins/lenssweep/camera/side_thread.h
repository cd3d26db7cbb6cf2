/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

namespace dff {

/* A thread beside its owner, for calls that may take long: those over a lens's bus, and a camera's commands.
 * What it finds out is put down here until its owner takes it. Nothing else is shared: while it runs, what
 * the work uses is the work's alone. Times are of the host's CLOCK_MONOTONIC. */
template <typename News> class SideThread {
public:
    using Work = std::function<void(const std::stop_token &)>;

    /* `on_news` is called by the thread when there is something to take. */
    explicit SideThread(std::function<void()> on_news) : on_news_(std::move(on_news)) {}
    ~SideThread() { stop(); }
    SideThread(const SideThread &) = delete;
    SideThread &operator=(const SideThread &) = delete;

    /* For the owner. stop() returns when the work has ended; what it told can still be taken. */
    void start(Work work)
    {
        stop();
        asked_.reset();
        thread_ = std::jthread([this, work = std::move(work)](const std::stop_token &stop) {
            try {
                work(stop);
            } catch (...) {
                put([this] { error_ = std::current_exception(); });
            }
        });
    }

    void stop()
    {
        if (!thread_.joinable())
            return;
        thread_.request_stop();
        thread_.join();
    }

    /* The work is wanted at that time, instead of one that was asked for before. */
    void ask(std::int64_t time_ns)
    {
        const std::lock_guard lock(mutex_);
        asked_ = time_ns;
        changed_.notify_all();
    }

    std::vector<News> take()
    {
        const std::lock_guard lock(mutex_);
        return std::exchange(news_, {});
    }

    /* What has ended the work; once. */
    std::exception_ptr take_error()
    {
        const std::lock_guard lock(mutex_);
        return std::exchange(error_, nullptr);
    }

    /* For the work. */
    void tell(News news)
    {
        put([&] { news_.push_back(std::move(news)); });
    }

    /* Returns when the work is wanted, `longest` has passed without that, or it is to stop. */
    void wait_until_asked(std::chrono::nanoseconds longest, const std::stop_token &stop)
    {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, stop, longest, [this] { return asked_.has_value(); });
        if (const auto time_ns = std::exchange(asked_, std::nullopt))
            changed_.wait_until(lock, stop, Time(std::chrono::nanoseconds(*time_ns)), [] { return false; });
    }

    /* False if it is to stop. */
    bool sleep_until(std::int64_t time_ns, const std::stop_token &stop)
    {
        std::unique_lock lock(mutex_);
        changed_.wait_until(lock, stop, Time(std::chrono::nanoseconds(time_ns)), [] { return false; });
        return !stop.stop_requested();
    }

private:
    using Time = std::chrono::steady_clock::time_point;

    template <typename Change> void put(Change change)
    {
        {
            const std::lock_guard lock(mutex_);
            change();
        }
        on_news_();
    }

    std::function<void()> on_news_;
    std::mutex mutex_; /* guards the three below; nothing is locked within */
    std::vector<News> news_;
    std::exception_ptr error_;
    std::optional<std::int64_t> asked_;
    std::condition_variable_any changed_;
    std::jthread thread_;
};

} // namespace dff
