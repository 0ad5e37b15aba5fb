// SPDX-License-Identifier: GPL-3.0-or-later
// Every file of data/regress gets an answer or a typed error within limits, never a crash.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "exactcsg/io/model.hpp"
#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"

namespace exactcsg::test {
namespace {

namespace fs = std::filesystem;

// Sanitizers make the code up to twenty times slower.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::chrono::seconds time_limit{100};
#else
constexpr std::chrono::seconds time_limit{10};
#endif

// Cancels the work with Error(TimeLimit) when the time is over.
class TimeLimited {
 public:
  TimeLimited()
      : watch_([this] {
          std::unique_lock lock(mutex_);
          if (!done_.wait_for(lock, time_limit, [this] { return is_done_; }))
            progress_.cancel(ErrorId::TimeLimit);
        }) {}
  TimeLimited(const TimeLimited&) = delete;
  TimeLimited& operator=(const TimeLimited&) = delete;
  ~TimeLimited() {
    {
      const std::lock_guard lock(mutex_);
      is_done_ = true;
    }
    done_.notify_all();
    watch_.join();
  }
  Progress* progress() { return &progress_; }

 private:
  Progress progress_;
  std::mutex mutex_;
  std::condition_variable done_;
  bool is_done_ = false;
  std::thread watch_;
};

fs::path regress_folder() { return fs::path(EXACTCSG_SOURCE_DIR) / "data" / "regress"; }

std::vector<std::string> regress_files() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(regress_folder())) {
    if (entry.path().extension() != ".md") names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

io::Model read(const fs::path& file, const io::ReadOptions& options) {
  for (const char* const mesh : {".off", ".stl", ".obj", ".ply"}) {
    if (file.extension() == mesh) return io::read_model(file, options);
  }
  std::ifstream stream(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(stream)), {});
  return io::read_openscad_csg(text, file.string(), options);
}

class Regress : public testing::TestWithParam<std::string> {};

TEST_P(Regress, IsAnsweredOrRefused) {
  for (const auto rounding : {io::Rounding::AsWritten, io::Rounding::OpenScadGrid}) {
    TimeLimited limited;
    try {
      io::ReadOptions read_options;
      read_options.rounding = rounding;
      read_options.progress = limited.progress();
      const io::Model model = read(regress_folder() / GetParam(), read_options);
      EvaluateOptions evaluate_options;
      evaluate_options.progress = limited.progress();
      const Boundary boundary = evaluate(model.solid, evaluate_options);
      // A closed surface has no negative volume.
      EXPECT_GE(enclose_volume(boundary, 64).upper, 0);
    } catch (const Error& error) {
      // A fault of ours is no answer, however it is typed.
      EXPECT_NE(error.id(), ErrorId::InternalError) << error.what();
      EXPECT_NE(error.id(), ErrorId::TimeLimit) << error.what();
    }
  }
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Files, Regress, testing::ValuesIn(regress_files()), test_name);

// Boxes on unit squares that do not overlap: the volume is the sum of the heights
// 4 + (2i - 19)(2j - 19) / 100 for i, j = 0 .. 19, and the deviations from 4 cancel: 400 * 4.
TEST(RegressFiles, SaddleOfBoxesHasTheSumOfItsBoxes) {
  TimeLimited limited;
  EvaluateOptions options;
  options.progress = limited.progress();
  const io::Model model = io::read_model(regress_folder() / "saddle_of_boxes.csg");
  EXPECT_EQ(model.primitives, 400U);
  EXPECT_EQ(*exact_volume(evaluate(model.solid, options)), 1600);
}

}  // namespace
}  // namespace exactcsg::test
