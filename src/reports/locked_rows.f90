!> Rows of tables on forces where friction locks the linkage.
module locked_rows
  use friction_study, only: lock_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: is_locked_at, lock_at

contains

  !> Whether friction locks the linkage in a row of a table on forces.
  pure function is_locked_at(variant, table, position, speed) result(is)
    type(variant_results_t), intent(in) :: variant !! with its results
    character(len=*), intent(in) :: table          !! name
    integer, intent(in) :: position, speed         !! numbers in the deck's lists
    logical :: is

    type(lock_t) :: lock

    is = .false.
    if (.not. allocated(variant%mechanism%linkage%frictions)) return
    lock = lock_at(variant, table, position, speed)
    is = lock%friction > 0
  end function is_locked_at

  !> Where it does. Of a balanced linkage, first that without counterweights.
  pure function lock_at(variant, table, position, speed) result(lock)
    type(variant_results_t), intent(in) :: variant !! with its results
    character(len=*), intent(in) :: table          !! name; blank: any table of the deck
    integer, intent(in) :: position, speed         !! numbers in the deck's lists
    type(lock_t) :: lock

    logical :: any_table

    any_table = len_trim(table) == 0
    associate (found => variant%found)
      if (any_table .or. any(table == [character(len=11) :: "reactions", "bearings", "frame", &
        "drives", "drive", "balance", "coordinates"])) call find_lock(found%joints%lock)
      if (any_table .or. table == "balance") call find_lock(found%balance%balanced%lock)
      if (any_table .or. table == "lagrange") call find_lock(found%lagrange%lock)
      if (any_table .or. table == "friction") call find_lock(found%friction%lock)
    end associate

  contains

    !> The lock of a result, if there is none yet.
    pure subroutine find_lock(locks)
      type(lock_t), allocatable, intent(in) :: locks(:, :) !! (speeds, states)

      if (.not. allocated(locks) .or. lock%friction > 0) return
      if (speed > size(locks, 1)) return
      lock = locks(speed, variant%found%positions%state(position))
    end subroutine find_lock

  end function lock_at

end module locked_rows
