#include "running.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

namespace vmesh::python {
namespace {

namespace py = pybind11;

constexpr std::chrono::milliseconds kBetweenLooks(50);

/// Communication between the working thread and the waiting one.
class Exchange {
 public:
  Progress progress() {
    return [this](std::string_view stage, double fraction) {
      if (cancelled_) return false;
      const std::lock_guard lock(mutex_);
      stage_ = stage;
      fraction_ = fraction;
      is_new_ = true;
      return true;
    };
  }
  void cancel() { cancelled_ = true; }

  void finish(std::exception_ptr error) {
    {
      const std::lock_guard lock(mutex_);
      error_ = std::move(error);
      done_ = true;
    }
    finished_.notify_one();
  }
  bool wait() {
    std::unique_lock lock(mutex_);
    return finished_.wait_for(lock, kBetweenLooks, [this] { return done_; });
  }
  std::exception_ptr error() const { return error_; }

  struct Report {
    std::string stage;
    double fraction;
  };
  std::optional<Report> take_report() {
    const std::lock_guard lock(mutex_);
    if (!is_new_) return std::nullopt;
    is_new_ = false;
    return Report{stage_, fraction_};
  }

 private:
  std::atomic<bool> cancelled_ = false;
  std::mutex mutex_;
  std::condition_variable finished_;
  std::string stage_;
  double fraction_ = 0;
  bool is_new_ = false, done_ = false;
  std::exception_ptr error_;
};

/// Reports to the callback; returns whether to continue.
bool tell(const py::object& callback, Exchange& exchange) {
  if (callback.is_none()) return true;
  const auto report = exchange.take_report();
  if (!report) return true;
  const py::object answer = callback(report->stage, report->fraction);
  return answer.is_none() || answer.cast<bool>();
}

void look_around(const py::object& callback, Exchange& exchange) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (!tell(callback, exchange)) throw Cancelled();
}

}  // namespace

void run(const py::object& callback, const std::function<void(const Progress&)>& work) {
  if (!callback.is_none() && PyCallable_Check(callback.ptr()) == 0)
    throw py::type_error("progress must be a function of a stage and a fraction, or None");
  Exchange exchange;
  std::thread worker([&] {
    try {
      work(exchange.progress());
      exchange.finish(nullptr);
    } catch (...) {
      exchange.finish(std::current_exception());
    }
  });
  std::exception_ptr raised;
  const auto wait = [&] {
    const py::gil_scoped_release release;
    return exchange.wait();
  };
  while (!wait()) {
    if (raised) continue;
    try {
      look_around(callback, exchange);
    } catch (...) {
      raised = std::current_exception();
      exchange.cancel();
    }
  }
  worker.join();
  if (raised) std::rethrow_exception(raised);
  if (exchange.error()) std::rethrow_exception(exchange.error());
  if (!tell(callback, exchange)) throw Cancelled();
}

}  // namespace vmesh::python
