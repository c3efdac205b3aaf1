// SPDX-License-Identifier: Apache-2.0
#include "scenes/python/running.hpp"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

namespace tesserae::python {
namespace {

namespace py = pybind11;

/// Between two looks at signals and at how far the work is, usual 50 ms: less often makes the user
/// wait.
constexpr std::chrono::milliseconds kBetweenLooks{50};

/// Work in its thread, and what it and its user tell each other.
class WatchedWork {
  public:
    explicit WatchedWork(const std::function<void(const Control&)>& work)
        : thread_([this, &work] { run(work); }) {}
    /// Ends the work, if it has not ended.
    ~WatchedWork() { end(); }
    WatchedWork(const WatchedWork&) = delete;
    WatchedWork& operator=(const WatchedWork&) = delete;

    /// Waits a while for the end of the work. Returns whether it has ended.
    bool wait() {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, kBetweenLooks, [this] { return ended_; });
    }
    /// Returns how far the work is, if it is farther than at the last call.
    std::optional<std::pair<std::uint64_t, std::uint64_t>> news() {
        const std::lock_guard lock(mutex_);
        if (done_ == told_) return {};
        told_ = done_;
        return std::pair(done_, total_);
    }
    void end() {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
    }
    /// What the work has thrown. It must have ended.
    std::exception_ptr error() const { return error_; }

  private:
    void run(const std::function<void(const Control&)>& work) {
        const auto tell = [this](std::uint64_t done, std::uint64_t total) {
            const std::lock_guard lock(mutex_);
            done_ = done, total_ = total;
            return true;
        };
        try {
            work({tell, &stop_});
        } catch (...) {
            error_ = std::current_exception();
        }
        const std::lock_guard lock(mutex_);
        ended_ = true;
        changed_.notify_all();
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::uint64_t done_ = 0, total_ = 0, told_ = 0;
    bool ended_ = false;
    std::atomic<bool> stop_ = false;
    std::exception_ptr error_;
    std::thread thread_;  ///< last: it uses the others
};

/// Returns what is called with (done, total), or None.
py::object teller_of(const py::object& progress) {
    if (progress.is_none() || progress.is(py::bool_(false))) return py::none();
    if (progress.is(py::bool_(true)))
        return py::module_::import("tesserae.progress").attr("Line")();
    if (PyCallable_Check(progress.ptr()) == 0)
        throw py::type_error("progress: expected a function of (done, total), True or None");
    return progress;
}

}  // namespace

void run_watched(const py::object& progress, const std::function<void(const Control&)>& work) {
    const py::object teller = teller_of(progress);
    WatchedWork watched(work);
    std::exception_ptr error;
    for (bool ended = false; !ended && !error;) {
        {
            const py::gil_scoped_release without_lock;
            ended = watched.wait();
        }
        try {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            if (const auto news = watched.news(); news && !teller.is_none())
                teller(news->first, news->second);
        } catch (...) {
            error = std::current_exception();
        }
    }
    {
        const py::gil_scoped_release without_lock;
        watched.end();
    }
    if (!error) error = watched.error();
    if (error) std::rethrow_exception(error);
}

}  // namespace tesserae::python
