/// The numbers of a result in one list: the order and the names that every interface gives them.
#pragma once

namespace pindrive {

template <class T, class Result>
struct NamedNumber {
  const char* name;
  T (*of)(const Result&);
};

}  // namespace pindrive
