#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// What a step of a scene can have.
struct StepShape {
  std::size_t objects = 1;   ///< 1..kMaxObjects
  std::size_t styluses = 1;  ///< 1..kMaxStyluses
  bool floor = true;         ///< objects touch a floor
  bool bodies = true;        ///< objects touch each other or scenery
};

StepShape step_shape(const SimulationConfig& config);

/// Every step counts: a bounded queue from one producer thread to one consumer thread, as
/// BoundedQueue. It keeps of a step what counts, each kind of thing in a ring of its own, so that
/// its memory and the time of a push are those of what happens. A step that does not fit into all
/// rings is refused.
class StepQueue {
 public:
  /// @param capacity steps, >= 1: that have up to kUsualContacts contacts between bodies, as many
  /// forces of the floor on each of two objects, two touched objects a stylus and kUsualLate late
  /// forces in the mean. Any single step fits.
  StepQueue(std::size_t capacity, const StepShape& shape);

  /// Producer: false when there is too little room; the step is then not taken.
  bool push(const StepRecord& record) noexcept;
  /// Producer: whether any step of the shape fits.
  bool has_room() const noexcept;
  /// Consumer: false when there is nothing to take. As copy_step().
  bool pop(StepRecord& record) noexcept;

 private:
  static constexpr std::size_t kUsualContacts = 64;
  static constexpr std::size_t kUsualLate = 4;

  /// A ring from the producer to the consumer, who learns otherwise of what is in it.
  template <typename T>
  class Ring {
   public:
    explicit Ring(std::size_t capacity) : items_(capacity) {}

    bool fits(std::size_t count) const noexcept {
      return items_.size() - (written_ - free_.load(std::memory_order_acquire)) >= count;
    }
    void write(const T& item) noexcept { items_[written_++ % items_.size()] = item; }
    const T& read() noexcept { return items_[read_++ % items_.size()]; }
    /// After reading: what was read may be written over.
    void release() noexcept { free_.store(read_, std::memory_order_release); }

   private:
    std::vector<T> items_;
    std::size_t written_ = 0;  ///< producer
    std::size_t read_ = 0;     ///< consumer
    std::atomic<std::size_t> free_{0};
  };

  struct Head {
    StepHead step;
    std::size_t late = 0;
    std::size_t contacts = 0;
    std::size_t bodies = 0;
  };
  /// One that is not free.
  struct Contact {
    std::size_t object = 0;
    std::size_t stylus = 0;
    ContactRecord record;
  };
  struct Counts {
    std::size_t objects = 0;
    std::size_t styluses = 0;
    std::size_t contacts = 0;
    std::size_t floor = 0;
    std::size_t late = 0;
    std::size_t bodies = 0;
  };
  static Counts most(const StepShape& shape) noexcept;
  static Counts count(const StepRecord& record) noexcept;
  static Counts room_for(std::size_t capacity, const StepShape& shape) noexcept;
  StepQueue(const Counts& most, std::size_t capacity, const Counts& room);
  bool fits(const Counts& counts) const noexcept;

  Counts most_;
  Ring<Head> heads_;
  Ring<ObjectStep> objects_;
  Ring<StylusRecord> styluses_;
  Ring<Contact> contacts_;
  Ring<FloorForce> floor_;
  Ring<LateForce> late_;
  Ring<BodyContactRecord> bodies_;
  std::atomic<std::uint64_t> pushed_{0};  ///< steps
  std::uint64_t popped_ = 0;              ///< steps; consumer
};

}  // namespace irdm
