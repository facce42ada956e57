#include "amontons/solution/form_choice.h"

#include "amontons/algebra/coupled_form.h"

namespace amontons
{
std::unique_ptr<SystemForm> make_form(const Model &model)
{
  return std::make_unique<CoupledForm>(model.layout(), model.bodies().subdomains(), make_direct_solver());
}
} // namespace amontons
