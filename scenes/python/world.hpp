// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <stdexcept>

#include "core/world/world.hpp"
#include "scenes/python/arrays.hpp"

namespace tesserae::python {

/// What Python's class World holds. While a thread steps it, without Python's lock, no other may
/// use it.
class SharedWorld {
  public:
    SharedWorld(World world, int threads) : world_(std::move(world)), threads_(threads) {}

    /// Returns the world. Python's lock must be held.
    /// @throws std::runtime_error   another thread steps it
    World& get() {
        require_idle();
        return world_;
    }
    const World& get() const {
        require_idle();
        return world_;
    }
    /// The number of threads that was asked for; 0: all cores.
    int threads() const { return threads_; }
    void set_threads(int threads);

    /// Keeps others out, as long as it lives. Python's lock must be held where it begins and ends.
    class Use {
      public:
        explicit Use(SharedWorld& shared) : shared_(shared) {
            shared.require_idle();
            shared.busy_ = true;
        }
        ~Use() { shared_.busy_ = false; }
        Use(const Use&) = delete;
        Use& operator=(const Use&) = delete;
        World& world() { return shared_.world_; }

      private:
        SharedWorld& shared_;
    };

  private:
    void require_idle() const {
        if (busy_)
            throw std::runtime_error(
                "this world is stepped by another thread; expected one thread at a time");
    }

    World world_;
    int threads_;
    bool busy_ = false;
};

using WorldClass = py::class_<SharedWorld>;

/// What a world has is added by topic.
void add_bodies(WorldClass& world);
void add_joints(WorldClass& world);
void add_readings(WorldClass& world);

void add_views(WorldClass& world);

/// Returns the threads for worlds: 0 are as many as cores.
/// @throws InputError   count < 0
std::shared_ptr<Workers> workers_of(int count);

/// Returns what may be the number of a body or joint; nothing for any other object.
std::optional<BodyId> number_in(const py::object& object);
/// Returns the number of a body: None is the world.
BodyId body_of(const py::object& body, const char* name);

}  // namespace tesserae::python
