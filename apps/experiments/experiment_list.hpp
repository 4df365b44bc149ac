#pragma once

#include "experiments/outcome.hpp"
#include "experiments/parallel.hpp"

namespace tegotae::experiments {

Outcome wall(const Work& work);
Outcome insertion(const Work& work);
Outcome task_time(const Work& work);
Outcome ladder(const Work& work);
Outcome hold(const Work& work);
Outcome widening(const Work& work);
Outcome wrench(const Work& work);
Outcome friction(const Work& work);
Outcome friction_tasks(const Work& work);

}  // namespace tegotae::experiments
