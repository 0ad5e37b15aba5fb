// SPDX-License-Identifier: Apache-2.0
#pragma once

// Tells ThreadSanitizer what the task scheduler guarantees: what one thread did before it handed
// something over happened before what the other does after taking it. oneTBB of the distribution is
// not instrumented, so without this every task would look like a race; and to silence all reports
// from inside tasks would hide real ones. Nothing at all in other builds.

#if defined(__SANITIZE_THREAD__)
#define EXACTCSG_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define EXACTCSG_THREAD_SANITIZER 1
#endif
#endif

#ifdef EXACTCSG_THREAD_SANITIZER
extern "C" {
void __tsan_acquire(void* address);
void __tsan_release(void* address);
}
#endif

namespace exactcsg::detail {

inline void hand_over([[maybe_unused]] const void* thing) noexcept {
#ifdef EXACTCSG_THREAD_SANITIZER
  __tsan_release(const_cast<void*>(thing));
#endif
}
inline void take_over([[maybe_unused]] const void* thing) noexcept {
#ifdef EXACTCSG_THREAD_SANITIZER
  __tsan_acquire(const_cast<void*>(thing));
#endif
}

struct HandOverAtEnd {
  const void* thing;
  explicit HandOverAtEnd(const void* t) noexcept : thing(t) {}
  HandOverAtEnd(const HandOverAtEnd&) = delete;
  HandOverAtEnd& operator=(const HandOverAtEnd&) = delete;
  ~HandOverAtEnd() { hand_over(thing); }
};
struct TakeOverAtEnd {
  const void* thing;
  explicit TakeOverAtEnd(const void* t) noexcept : thing(t) {}
  TakeOverAtEnd(const TakeOverAtEnd&) = delete;
  TakeOverAtEnd& operator=(const TakeOverAtEnd&) = delete;
  ~TakeOverAtEnd() { take_over(thing); }
};

// The work of one task. The scheduler copies it into memory of its own: the copy is handed over,
// and when it is done, `results` is.
template <class Work>
class HandedOver {
 public:
  HandedOver(Work work, const void* results) : work_(work), results_(results) {}
  HandedOver(const HandedOver& other) : work_(other.work_), results_(other.results_) {
    hand_over(this);
  }
  HandedOver& operator=(const HandedOver&) = delete;
  void operator()() const {
    take_over(this);
    const HandOverAtEnd done(results_);
    work_();
  }

 private:
  Work work_;
  const void* results_;
};

}  // namespace exactcsg::detail
