// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <type_traits>

namespace tesserae {

/// A FunctionRef calls a function object that lives elsewhere. It takes no memory of its own and
/// costs a call through a pointer. It serves for arguments of virtual functions. It must not
/// outlive the object that it was made from.
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
