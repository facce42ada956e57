#include "amontons/output/checkpoint_file.h"

#include "amontons/base/error.h"

#include <array>
#include <cstring>
#include <fstream>
#include <type_traits>

namespace amontons
{
using Json = nlohmann::ordered_json;

namespace
{
/// To be counted up when the content changes.
constexpr int format = 3;

template<class T>
Json bytes(const std::vector<T> &values)
{
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<std::uint8_t> out(values.size() * sizeof(T));
  if (!values.empty())
    std::memcpy(out.data(), values.data(), out.size());
  return Json::binary(std::move(out));
}

template<class T>
void read(const Json &from, std::vector<T> &values)
{
  const std::vector<std::uint8_t> &in = from.get_binary();
  values.resize(in.size() / sizeof(T));
  if (!values.empty())
    std::memcpy(values.data(), in.data(), values.size() * sizeof(T));
}

Json to_json(const State &state)
{
  return {{"displacement", bytes(state.displacement)},
          {"rigid", bytes(to_numbers(state.rigid))},
          {"multipliers", bytes(state.multipliers)}};
}

State to_state(const Json &from)
{
  State out;
  std::vector<double> rigid;
  read(from.at("displacement"), out.displacement);
  read(from.at("rigid"), rigid);
  read(from.at("multipliers"), out.multipliers);
  out.rigid = to_rigid_states(rigid);
  return out;
}

Json to_json(const ContactHistory &history)
{
  return {{"nodes", bytes(history.nodes)},
          {"pairing", bytes(history.pairing)},
          {"face_nodes", bytes(history.face_nodes)},
          {"status", bytes(history.status)},
          {"total_slip", bytes(history.total_slip)}};
}

ContactHistory to_history(const Json &from)
{
  ContactHistory out;
  read(from.at("nodes"), out.nodes);
  read(from.at("pairing"), out.pairing);
  read(from.at("face_nodes"), out.face_nodes);
  read(from.at("status"), out.status);
  read(from.at("total_slip"), out.total_slip);
  return out;
}

static_assert(std::is_trivially_copyable_v<Counters>);

Json to_json(const Checkpoint &checkpoint)
{
  Json out = {{"problem_key", checkpoint.problem_key},
              {"increment", checkpoint.increment},
              {"time", checkpoint.time},
              {"next_step", checkpoint.next_step},
              {"last_motion", checkpoint.last_motion},
              {"linear_solver", checkpoint.linear_solver},
              {"state", to_json(checkpoint.state)},
              {"contacts", Json::array()},
              {"cells", bytes(checkpoint.cells.cells)},
              {"cell_offset", bytes(checkpoint.cells.offset)},
              {"cell_values", bytes(checkpoint.cells.values)},
              {"counters", bytes(std::vector<Counters>{checkpoint.counters})}};
  if (const auto &last = checkpoint.last)
    out["last"] = {{"start", to_json(last->start)}, {"from", last->from}, {"to", last->to}};
  for (const ContactHistory &contact : checkpoint.contacts)
    out["contacts"].push_back(to_json(contact));
  return out;
}

Checkpoint to_checkpoint(const Json &from)
{
  Checkpoint out;
  from.at("problem_key").get_to(out.problem_key);
  from.at("increment").get_to(out.increment);
  from.at("time").get_to(out.time);
  from.at("next_step").get_to(out.next_step);
  from.at("last_motion").get_to(out.last_motion);
  from.at("linear_solver").get_to(out.linear_solver);
  out.state = to_state(from.at("state"));
  if (from.contains("last"))
  {
    const Json &last = from["last"];
    out.last = LastIncrement{to_state(last.at("start")), last.at("from"), last.at("to")};
  }
  for (const Json &contact : from.at("contacts"))
    out.contacts.push_back(to_history(contact));
  read(from.at("cells"), out.cells.cells);
  read(from.at("cell_offset"), out.cells.offset);
  read(from.at("cell_values"), out.cells.values);
  std::vector<Counters> counters;
  read(from.at("counters"), counters);
  out.counters = counters.at(0);
  return out;
}
} // namespace

void CheckpointWriter::checkpoint(const Checkpoint &checkpoint)
{
  if (!folder_.communicator().is_root())
    return;
  const Json content = {{"format", format},
                        {"checkpoint", to_json(checkpoint)},
                        {"record", record_.written()},
                        {"series", pictures_.series()}};
  std::string text;
  Json::to_cbor(content, text);
  folder_.write(checkpoint_file, text);
}

SavedRun read_checkpoint(const std::filesystem::path &file)
{
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw UserError("cannot read the checkpoint '" + file.string() + "'");
  try
  {
    const Json content = Json::from_cbor(in);
    if (content.at("format") != format)
      throw UserError("the checkpoint '" + file.string() + "' was written by another version of amontons");
    return {to_checkpoint(content.at("checkpoint")), content.at("record"), content.at("series")};
  }
  catch (const UserError &)
  {
    throw;
  }
  catch (const std::exception &)
  {
    throw UserError("'" + file.string() + "' is no checkpoint: amontons writes them as " + checkpoint_file +
                    " where the deck says output: {checkpoint: n}");
  }
}
} // namespace amontons
