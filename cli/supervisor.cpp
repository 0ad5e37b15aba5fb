// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/supervisor.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <future>
#include <new>
#include <optional>
#include <system_error>
#include <thread>

#include "cli/terminal.hpp"
#include "exactcsg/support/version.hpp"

namespace exactcsg::cli {

namespace {

using Clock = std::chrono::steady_clock;

volatile std::sig_atomic_t interrupted = 0;

// The second signal ends the process at once.
void on_interrupt(int signal_number) {
  interrupted = 1;
  (void)std::signal(signal_number, SIG_DFL);
}

struct Outcome {
  Answer answer = Answer::Yes;
  std::optional<Error> error;
  std::string internal_error;  // of an exception that is not ours
};

Outcome out_of_memory(const Context& context) {
  const std::size_t limit = context.common().memory_limit;
  return {{},
          Error(ErrorId::OutOfMemory,
                {limit == 0 ? std::string("no memory left")
                            : fmt::format("more than {} MiB needed", limit >> 20U),
                 "a model that fits, or a larger --memory-limit"}),
          {}};
}

// Thrown where a thread cannot be started for want of memory.
bool says_out_of_memory(const std::system_error& error) {
  return error.code() == std::errc::resource_unavailable_try_again ||
         error.code() == std::errc::not_enough_memory;
}

Outcome run(const Command& command, Context& context) {
  try {
    return {command.work(context), {}, {}};
  } catch (const Error& error) {
    return {{}, error, {}};
  } catch (const std::bad_alloc&) {
    return out_of_memory(context);
  } catch (const std::system_error& error) {
    if (says_out_of_memory(error)) return out_of_memory(context);
    return {{}, {}, error.what()};
  } catch (const std::exception& error) {
    return {{}, {}, error.what()};
  } catch (...) {
    return {{}, {}, "an exception of unknown type"};
  }
}

std::string progress_text(const Progress& progress, double seconds) {
  const auto done = progress.done();
  const auto total = progress.total();
  if (const double width = progress.relative_width(); width >= 0) {
    return fmt::format("{} {}, width {:.1e} [{:.1f} s]", progress.stage(), done, width, seconds);
  }
  if (total == 0) {
    return done == 0 ? fmt::format("{} [{:.1f} s]", progress.stage(), seconds)
                     : fmt::format("{} {} [{:.1f} s]", progress.stage(), done, seconds);
  }
  const double percent =
      100.0 * static_cast<double>(std::min(done, total)) / static_cast<double>(total);
  return fmt::format("{} {:.0f}% [{:.1f} s]", progress.stage(), percent, seconds);
}

// Programs that the work started (openscad) must not outlive the command.
void end_child_processes() {
  std::error_code ignored;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", ignored)) {
    std::ifstream children(task.path() / "children");
    for (pid_t child = 0; children >> child;) (void)kill(child, SIGKILL);
  }
}

int report(const Outcome& outcome) {
  if (outcome.error) {
    print_error(outcome.error->what());
    const ErrorDescription& description = describe(outcome.error->id());
    if (description.exit_code != 3) return description.exit_code;
  } else {
    print_error(Error(ErrorId::InternalError, {outcome.internal_error, ""}).what());
  }
  print_message(fmt::format(
      "This is exactcsg {}. Please report the command line, the model and the lines above to the "
      "maintainers; the answer was not printed because it could be wrong.",
      version));
  return 3;
}

}  // namespace

int supervise(const Command& command, Context& context) {
  using std::chrono::duration;
  const auto start = Clock::now();
  const double limit = context.common().time_limit_seconds;
  Progress& progress = context.progress();
  (void)std::signal(SIGINT, on_interrupt);
  (void)std::signal(SIGTERM, on_interrupt);

  std::promise<Outcome> promise;
  auto future = promise.get_future();
  std::thread worker;
  try {
    worker = std::thread([&] { promise.set_value(run(command, context)); });
  } catch (const std::system_error& error) {
    if (says_out_of_memory(error)) return report(out_of_memory(context));
    throw;
  }

  const auto print_warnings = [&] {
    for (const std::string& warning : context.take_warnings()) print_message(warning);
  };
  struct Stop {
    ErrorId reason;
    double seconds;  // when the work was asked to stop
  };
  std::optional<Stop> stop;
  // Short waits at first, so that quick answers are quick.
  auto pause = std::chrono::milliseconds(5);
  while (future.wait_for(pause) != std::future_status::ready) {
    pause = std::min(pause * 2, std::chrono::milliseconds(100));
    print_warnings();
    const double seconds = duration<double>(Clock::now() - start).count();
    if (!stop && interrupted != 0) stop = {ErrorId::Cancelled, seconds};
    if (!stop && limit > 0 && seconds > limit) stop = {ErrorId::TimeLimit, seconds};
    if (stop) progress.cancel(stop->reason);
    if (stop && seconds > stop->seconds + grace_seconds) {
      print_warnings();
      print_error(Error(stop->reason, {fmt::format("{:.0f} s used", seconds), ""}).what());
      end_child_processes();
      std::_Exit(describe(stop->reason).exit_code);
    }
    if (!context.common().quiet && seconds > 0.3) {
      show_progress_line(progress_text(progress, seconds));
    }
  }
  worker.join();
  clear_progress_line();
  print_warnings();
  const Outcome outcome = future.get();
  if (outcome.error || !outcome.internal_error.empty()) return report(outcome);
  print_data(context.output());
  if (context.first_refusal()) return describe(*context.first_refusal()).exit_code;
  return static_cast<int>(outcome.answer);
}

}  // namespace exactcsg::cli
