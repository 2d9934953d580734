#pragma once
// What a stage last ran with: its own settings struct and the versions of its input. It runs again
// where they differ, so that no list says which settings matter to what.

#include <optional>
#include <tuple>

namespace mv {

template <typename... Inputs>
class LastInputs {
  public:
    bool operator==(const std::tuple<Inputs...>& inputs) const { return last_ == inputs; }
    void operator=(std::tuple<Inputs...> inputs) { last_ = std::move(inputs); }
    // The stage runs next time whatever it is given.
    void forget() { last_.reset(); }
    bool known() const { return last_.has_value(); }

  private:
    std::optional<std::tuple<Inputs...>> last_;
};

}  // namespace mv
