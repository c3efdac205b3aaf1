#pragma once

#include <memory>
#include <type_traits>

namespace tesserae {

/// Calls something that lives elsewhere, at the cost of a call through a pointer and without taking
/// memory: for arguments of virtual functions. Lives no longer than what it was made from.
template <class Signature>
class FunctionRef;

template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
  public:
    template <class Function>
    requires(!std::is_same_v<Function, FunctionRef>) FunctionRef(const Function& function)
        : function_(std::addressof(function)), call_([](const void* f, Arguments... arguments) {
              return (*static_cast<const Function*>(f))(arguments...);
          }) {}

    Result operator()(Arguments... arguments) const { return call_(function_, arguments...); }

  private:
    const void* function_;
    Result (*call_)(const void*, Arguments...);
};

}  // namespace tesserae
