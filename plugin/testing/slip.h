/** @file
 * @brief Slips that are compiled together and chosen at run time: what `plugin/run mutate` puts in front of every file.
 *
 * PALPATE_SLIP holds the number of the slip that acts, PALPATE_SLIPS_RUN the file whose byte n becomes 1 where the
 * place of slip n is run. An operator is swapped without knowing its operands: `a + b` is written `a + Plus{n} + b`,
 * which binds alike.
 */
#pragma once
#ifdef __cplusplus
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <initializer_list>
#include <utility>

namespace slip {

constexpr int most = 4096;

struct State {
  int chosen = -1;
  unsigned char* ran = nullptr;
};

inline State load() {
  State state;
  if (const char* number = std::getenv("PALPATE_SLIP")) state.chosen = std::atoi(number);
  if (const char* name = std::getenv("PALPATE_SLIPS_RUN")) {
    const int file = ::open(name, O_RDWR | O_CLOEXEC);
    void* at = file < 0 ? MAP_FAILED : ::mmap(nullptr, most, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (at != MAP_FAILED) state.ran = static_cast<unsigned char*>(at);
    if (file >= 0) ::close(file);
  }
  return state;
}

inline const State state = load();

inline bool on(int number) {
  if (state.ran != nullptr) state.ran[number] = 1;
  return state.chosen == number;
}

// `instead` is what is computed where the slip is on, of left.value and right.
#define PALPATE_INSTEAD(Name, op, instead)                                                        \
  struct Name {                                                                                   \
    int number;                                                                                   \
  };                                                                                              \
  template <class L>                                                                              \
  struct Left##Name {                                                                             \
    L&& value;                                                                                    \
    int number;                                                                                   \
  };                                                                                              \
  template <class L>                                                                              \
  Left##Name<L> operator op(L&& left, Name tag) {                                                 \
    return {std::forward<L>(left), tag.number};                                                   \
  }                                                                                               \
  template <class L, class R>                                                                     \
  auto operator op(Left##Name<L> left, R&& right)                                                 \
      ->std::decay_t<decltype(std::forward<L>(left.value) op std::forward<R>(right))> {           \
    using Result = std::decay_t<decltype(std::forward<L>(left.value) op std::forward<R>(right))>; \
    if (on(left.number)) return static_cast<Result>(instead);                                     \
    return std::forward<L>(left.value) op std::forward<R>(right);                                 \
  }
#define PALPATE_SWAP(Name, op, other) \
  PALPATE_INSTEAD(Name, op, std::forward<L>(left.value) other std::forward<R>(right))
PALPATE_SWAP(Plus, +, -)
PALPATE_SWAP(Minus, -, +)
PALPATE_SWAP(Times, *, /)
PALPATE_SWAP(Over, /, *)
PALPATE_SWAP(Less, <, <=)
PALPATE_SWAP(NotMore, <=, <)
PALPATE_SWAP(More, >, >=)
PALPATE_SWAP(NotLess, >=, >)
PALPATE_SWAP(LessTurned, <, >)
PALPATE_SWAP(MoreTurned, >, <)
PALPATE_SWAP(Equal, ==, !=)
PALPATE_SWAP(Different, !=, ==)
#undef PALPATE_SWAP
PALPATE_INSTEAD(NoPlus, +, std::forward<L>(left.value))
PALPATE_INSTEAD(NoMinus, -, std::forward<L>(left.value))
#undef PALPATE_INSTEAD

#define PALPATE_SWAP_EXTREME(Name, function, other)                                       \
  struct Name {                                                                           \
    int number;                                                                           \
    template <class... A>                                                                 \
    auto operator()(const A&... a) const -> std::decay_t<decltype(std::function(a...))> { \
      if (on(number)) return std::other(a...);                                            \
      return std::function(a...);                                                         \
    }                                                                                     \
    template <class T>                                                                    \
    T operator()(std::initializer_list<T> list) const {                                   \
      return on(number) ? std::other(list) : std::function(list);                         \
    }                                                                                     \
  };
PALPATE_SWAP_EXTREME(Min, min, max)
PALPATE_SWAP_EXTREME(Max, max, min)
#undef PALPATE_SWAP_EXTREME

// `!x` is written `No{n} ->* x`, and so on: ->* is the operator that binds closest after those with one operand.
struct No {
  int number;
};
template <class T>
bool operator->*(No tag, T&& x) {
  return on(tag.number) ? static_cast<bool>(x) : !x;
}
struct Negative {
  int number;
};
template <class T>
auto operator->*(Negative tag, T&& x) -> std::decay_t<decltype(-x)> {
  if (on(tag.number)) return x;
  return -x;
}
struct Up {
  int number;
};
template <class T>
decltype(auto) operator->*(Up tag, T& x) {
  return on(tag.number) ? --x : ++x;
}

}  // namespace slip
#endif
