#include "amontons/algebra/feti_contact.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace amontons
{
namespace
{
/// An entry of a row on a column of another process.
struct ForeignEntry
{
  FetiInterface::Place place;
  double coefficient;
};

/// An entry of a row of G.
struct MotionEntry
{
  Index unknown;
  double coefficient;
};

std::vector<MotionEntry> packed(std::span<const FetiRows::Entry> row)
{
  std::vector<MotionEntry> out;
  for (const auto &[unknown, coefficient] : row)
    out.push_back({unknown, coefficient});
  return out;
}
} // namespace

void FetiContact::set(FetiContactRows given, std::span<const double> inverse_stiffness, double mean)
{
  symmetric_ = processes_.true_on_all(given.symmetric);
  springs_ = given.springs;
  scale_rows(given, inverse_stiffness, mean);
  const Whole whole{&given.rows, &given.forces};
  take_own(whole);
  exchange(whole);
  for (int k = 0; k < n_sides(); ++k)
    sides_[k].scaling.set(sides_[k].rows, inverse_stiffness, least_own_share(*whole[k], given, inverse_stiffness),
                          sharing_.counted_as(feti_setup_phase));
}

/// Gives every row of B length one in the inner product of D^-1.
void FetiContact::scale_rows(FetiContactRows &given, std::span<const double> inverse_stiffness, double mean)
{
  scale_.clear();
  for (Index row = 0; row < given.rows.size(); ++row)
  {
    double length2 = 0, plain = 0;
    for (const auto &[column, value] : given.rows[row])
    {
      length2 += value * value * inverse_stiffness[column];
      plain += value * value * mean;
    }
    scale_.push_back(1 / std::sqrt(length2 > 0 ? length2 : plain));
    given.rows.scale(row, scale_.back());
    given.forces.scale(row, scale_.back());
  }
}

void FetiContact::take_own(const Whole &whole)
{
  std::vector<FetiRows::Entry> entries;
  for (int k = 0; k < n_sides(); ++k)
  {
    sides_[k].rows.clear();
    sides_[k].motions.clear();
    for (Index row = 0; row < n_own(); ++row)
    {
      entries.clear();
      for (const FetiRows::Entry &entry : (*whole[k])[row])
        if (is_here(entry.first))
          entries.push_back(entry);
      sides_[k].rows.push_back(entries);
      kernel_.restrict_row((*whole[k])[row], entries);
      sides_[k].motions.push_back(entries);
    }
  }
}

/// To each process the own rows that touch its subdomains: their number here, then for each side what it is to know.
std::vector<Message> FetiContact::messages_to_others(const Whole &whole) const
{
  std::map<Rank, ByteWriter> writers;
  for (Index row = 0; row < n_own(); ++row)
  {
    std::map<Rank, std::array<std::vector<ForeignEntry>, 2>> foreign;
    for (int k = 0; k < n_sides(); ++k)
      for (const auto &[column, coefficient] : (*whole[k])[row])
        if (!is_here(column))
        {
          const FetiInterface::Place place = interface_.place(column);
          foreign[interface_.copies().rank_of(place.subdomain)][k].push_back({place, coefficient});
        }
    for (const auto &[rank, entries] : foreign)
    {
      writers[rank].add(row);
      for (int k = 0; k < n_sides(); ++k)
      {
        writers[rank].add_array(entries[k]);
        writers[rank].add_array(packed(sides_[k].motions[row]));
      }
    }
  }
  std::vector<Message> out;
  for (auto &[rank, writer] : writers)
    out.push_back({rank, writer.take()});
  return out;
}

void FetiContact::take_row_of_other(ByteReader &reader)
{
  std::vector<FetiRows::Entry> row;
  for (int k = 0; k < n_sides(); ++k)
  {
    row.clear();
    for (const ForeignEntry &entry : reader.get_array<ForeignEntry>())
      row.emplace_back(interface_.own_column(entry.place), entry.coefficient);
    sides_[k].rows.push_back(row);
    row.clear();
    for (const MotionEntry &entry : reader.get_array<MotionEntry>())
      row.emplace_back(entry.unknown, entry.coefficient);
    sides_[k].motions.push_back(row);
  }
}

void FetiContact::exchange(const Whole &whole)
{
  // So numbered, the copies of a row are looked after by the process that gives it.
  const auto id = [&](Index row, Rank rank) { return GlobalIndex(row) * processes_.n_processes() + rank; };
  std::vector<GlobalIndex> ids;
  for (Index row = 0; row < n_own(); ++row)
    ids.push_back(id(row, processes_.rank()));
  if (processes_.is_distributed())
    for (const Message &message : processes_.messages()->exchange(feti_setup_phase, messages_to_others(whole)))
    {
      ByteReader reader(message.bytes);
      while (!reader.is_at_end())
      {
        ids.push_back(id(reader.get<Index>(), message.rank));
        take_row_of_other(reader);
      }
    }
  std::vector<char> is_own(ids.size(), 0);
  std::fill_n(is_own.begin(), n_own(), 1);
  sharing_ = Sharing(processes_.messages(), feti_setup_phase, ids, is_own).counted_as(feti_contact_phase);
}

/// Of the rows' squared lengths what lies on columns of the impactor node or of a spring: the least, over all
/// processes.
double FetiContact::least_own_share(const FetiRows &rows, const FetiContactRows &given,
                                    std::span<const double> inverse_stiffness) const
{
  double least = HUGE_VAL;
  for (Index row = 0; row < rows.size(); ++row)
  {
    const auto is_own = [&](Index column)
    {
      if (column >= interface_.first_rigid_column() || given.impactors[row] < 0)
        return true; // rigid columns count nothing
      const auto copies = interface_.copies().of(given.impactors[row]);
      return std::any_of(copies.begin(), copies.end(),
                         [&](const FetiCopy &copy)
                         { return column >= copy.column && column < copy.column + interface_.dim(); });
    };
    double share = 0;
    for (const auto &[column, value] : rows[row])
      share += is_own(column) ? value * value * inverse_stiffness[column] : 0;
    least = std::min(least, share);
  }
  return -processes_.maximum_over_processes(-least);
}
} // namespace amontons
