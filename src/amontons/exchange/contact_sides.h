#pragma once
#include "amontons/detection/self_contact_roles.h"
#include "amontons/exchange/part_work.h"
#include "amontons/parallel/message_exchange.h"

#include <map>
#include <vector>

namespace amontons
{
/// Self-contact: once every part knows what its nodes see, decides who is impactor (Roles). A zone of contact may run
/// through any number of parts and its sides hang on all of it, so one process, another for each contact, is sent the
/// nodes that see a face, with the faces round them and those seen, and no more; it also keeps their roles.
class ContactSides
{
public:
  /// @param at_root whether process 0 decides for all contacts
  ContactSides(MessageExchange &messages, bool at_root)
    : messages_(messages)
    , at_root_(at_root)
  {
  }

  /// Takes their faces from the nodes that are targets. Collective; nothing is sent where no contact is self-contact.
  /// @return nodes that this process has held for it
  Index assign(PartWork &work);

private:
  /// What a part knows of one contact, as packed by it.
  struct Sight
  {
    Rank rank;
    Bytes bytes;
  };
  using RolesById = std::map<GlobalIndex, Roles::Role>;

  [[nodiscard]] Rank decider(std::size_t contact) const
  {
    return at_root_ ? 0 : static_cast<Rank>(contact % static_cast<std::size_t>(messages_.communicator().size()));
  }
  [[nodiscard]] std::vector<Message> ask(PartWork &work) const;
  std::vector<Message> answer(const std::vector<Message> &questions, Index &n_nodes);
  /// @param answers sight by sight, whether each node that sees a face is impactor @return nodes held for it
  Index decide(const std::vector<Sight> &sights, RolesById &kept, std::vector<std::vector<char>> &answers) const;
  void apply(PartWork &work, const std::vector<Message> &answers) const;

  MessageExchange &messages_;
  bool at_root_;
  std::map<std::size_t, RolesById> kept_; ///< by contact
};
} // namespace amontons
