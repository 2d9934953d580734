#pragma once
// A function of several functions, for std::visit: that is called which takes what a variant holds.

namespace mv {

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace mv
