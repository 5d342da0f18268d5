!> Remarks on counterweights and balance shafts, at the head of `balance.dat`.
module counterweight_notes
  use body_attachments, only: place_on_card
  use constants, only: degree
  use kinds, only: wp
  use numbers, only: shortest_text
  use partial_balance_study, only: aim_count
  use table_columns, only: table_unit
  use text, only: append_string, plural, string_t, to_string
  use units, only: from_si, unit_t
  use variant_results, only: variant_results_t
  implicit none (type, external)
  private

  public :: append_counterweight, append_partial_notes, balanced_by_cards, balance_log

  character(len=*), parameter :: aim_names(aim_count) = [character(len=17) :: "shaking force", &
    "shaking moment", "torque of inertia"]

contains

  !> What the balanced linkage has.
  pure function balanced_by_cards(variant) result(words)
    type(variant_results_t), intent(in) :: variant !! with a balance for BALANCE cards
    character(len=:), allocatable :: words

    if (size(variant%model%shafts) == 0) then
      words = "balanced: with the counterweights of the BALANCE card"
    else
      words = "balanced: with the counterweights and balance shafts of the BALANCE cards"
    end if
  end function balanced_by_cards

  !> What is minimised, how much of it is left, counterweights and balance shafts.
  pure subroutine append_partial_notes(variant, notes)
    type(variant_results_t), intent(in) :: variant         !! with a balance for BALANCE cards
    type(string_t), allocatable, intent(inout) :: notes(:) !! to which lines are appended

    type(unit_t) :: length
    character(len=:), allocatable :: heading
    integer :: i

    length = table_unit("length", variant%model%outputs)
    associate (balance => variant%found%balance, mechanism => variant%mechanism)
      if (allocated(balance%partial%error)) return
      call append_aims(variant, notes)
      do i = 1, size(balance%partial%idle)
        call append_string(notes, "no counterweight on link "// &
          mechanism%names(balance%partial%idle(i))%text// &
          ": it would change none of what is minimised, or only as those on the others do")
      end do
      do i = 1, size(balance%weights)
        associate (weight => balance%weights(i), diameter => balance%partial%diameter(i))
          heading = "card, with radius "//to_string(from_si(weight%radius, length), 12)//" "// &
            length%name//":"
          if (diameter > 0.0_wp) heading = "card, with radius "// &
            to_string(from_si(weight%radius, length), 12)//" "//length%name//", a disc of "// &
            "diameter "//to_string(from_si(diameter, length), 6)//" "// &
            length%name//":"
        end associate
        call append_counterweight(variant, i, heading, notes)
      end do
      if (.not. allocated(balance%partial%linkage%shafts)) return
      do i = 1, size(balance%partial%linkage%shafts)
        call append_shaft(variant, i, notes)
      end do
      if (size(balance%partial%linkage%shafts) == 0) call append_string(notes, &
        "no balance shafts: the shaking force has no such harmonics")
    end associate
  end subroutine append_partial_notes

  !> What is minimised, and how much of it is left.
  pure subroutine append_aims(variant, notes)
    type(variant_results_t), intent(in) :: variant
    type(string_t), allocatable, intent(inout) :: notes(:)

    character(len=:), allocatable :: aims
    integer :: i

    associate (partial => variant%found%balance%partial, aim => variant%model%balance%aim)
      aims = ""
      do i = 1, aim_count
        if (aim(i) > 0.0_wp .and. .not. partial%is_counted(i)) call append_string(notes, &
          "the "//trim(aim_names(i))//" is zero without counterweights, and not minimised")
        if (partial%is_counted(i)) aims = aims//", "//trim(aim_names(i))//" x "// &
          to_string(aim(i), 6)
      end do
      if (len(aims) > 0) then
        call append_string(notes, "minimised: sum of the mean squares over a turn at constant "// &
          "speed, each over that without counterweights, of "//aims(3:))
        if (partial%minimum%is_least) then
          call append_string(notes, "sum "//share_text(partial%minimum%value)// &
            " by counterweights; proved: none at these radii have less")
        else
          call append_string(notes, "sum "//share_text(partial%minimum%value)// &
            " by counterweights: the least of the minima found")
        end if
        if (partial%minimum%length_helps) call append_string(notes, "more moment of inertia "// &
          "with the same mass x radius would lessen the sum: try a larger radius")
      end if
      call append_string(notes, "rms over a turn at constant speed, balanced over given: "// &
        rms_shares(variant))
    end associate
  end subroutine append_aims

  !> The line of `run.log`: who bears counterweights, and how much they leave.
  pure function balance_log(variant) result(text)
    type(variant_results_t), intent(in) :: variant !! with a balance for BALANCE cards
    character(len=:), allocatable :: text

    integer :: i, shafts

    associate (balance => variant%found%balance)
      text = ""
      if (allocated(balance%partial%error)) return
      do i = 1, size(balance%weights)
        if (balance%weights(i)%needed) text = text//", "// &
          variant%mechanism%names(balance%weights(i)%body)%text
      end do
      if (len(text) > 0) text = "; counterweights of "//text(3:)
      shafts = 0
      if (allocated(balance%partial%linkage%shafts)) shafts = size(balance%partial%linkage%shafts)
      if (shafts > 0) text = text//"; "//plural(shafts, "balance shaft")
      if (len(text) == 0) text = "; nothing added"
      text = "balance: "//text(3:)//"; rms balanced over given: "//rms_shares(variant)//achar(10)
    end associate
  end function balance_log

  !> `shaking force 0.43, shaking moment 1.2, torque of inertia 1`: the rms in terms of that as
  !! given.
  pure function rms_shares(variant) result(shares)
    type(variant_results_t), intent(in) :: variant
    character(len=:), allocatable :: shares

    integer :: i

    shares = ""
    associate (partial => variant%found%balance%partial)
      do i = 1, aim_count
        shares = shares//", "//trim(aim_names(i))//" "
        if (partial%is_alive(i)) then
          shares = shares//share_text(partial%after(i)/partial%before(i))
        else
          shares = shares//"zero as given"
        end if
      end do
    end associate
    shares = shares(3:)
  end function rms_shares

  !> A share, in which rounding is 0.
  pure function share_text(share) result(text)
    real(wp), intent(in) :: share
    character(len=:), allocatable :: text

    text = "0"
    if (share > 1.0e-12_wp) text = to_string(share, 6)
  end function share_text

  !> Mass × radius and angle of a counterweight, and the MASS card for it.
  pure subroutine append_counterweight(variant, number, heading, list)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: number           !! of the counterweight
    character(len=*), intent(in) :: heading !! of the card
    type(string_t), allocatable, intent(inout) :: list(:)

    type(unit_t) :: mass, first_moment
    character(len=:), allocatable :: own
    real(wp) :: place(2)

    mass = table_unit("mass", variant%model%outputs)
    first_moment = table_unit("first_moment", variant%model%outputs)
    associate (weight => variant%found%balance%weights(number), &
        lump => variant%found%balance%lumps(number), mechanism => variant%mechanism)
      associate (name => mechanism%names(weight%body)%text)
        if (.not. weight%needed) then
          call append_string(list, "link "//name//" needs no counterweight")
          return
        end if
        call append_string(list, "counterweight of link "//name//": mass x radius "// &
          to_string(from_si(norm2(weight%first_moment), first_moment))//" "// &
          first_moment%name//", at "//to_string(atan2(weight%first_moment(2), &
          weight%first_moment(1))/degree)//" deg from "//mechanism%pin_names(weight%pin)%text// &
          " -> "//mechanism%pin_names(weight%towards)%text)
        ! The card has all digits: with 13 a deck that takes it would say that it needs another one.
        ! `place_on_card` is its own inverse: here it goes from the body to the card.
        place = from_si(place_on_card(variant%mechanism%linkage%bodies(weight%body), lump%place), &
          table_unit("length", variant%model%outputs)) + 0.0_wp
        own = ""
        if (lump%inertia > 0.0_wp) own = " inertia="//shortest_text(from_si(lump%inertia, &
          table_unit("inertia", variant%model%outputs)))
        call append_string(list, heading)
        call append_string(list, "MASS "//name//" at="//shortest_text(place(1))//" offset="// &
          shortest_text(place(2))//own//" "//shortest_text(from_si(lump%mass, mass))//mass%name)
      end associate
    end associate
  end subroutine append_counterweight

  !> Mass × radius, angle and place of a balance shaft.
  pure subroutine append_shaft(variant, number, list)
    type(variant_results_t), intent(in) :: variant
    integer, intent(in) :: number           !! of the shaft
    type(string_t), allocatable, intent(inout) :: list(:)

    type(unit_t) :: first_moment, length

    first_moment = table_unit("first_moment", variant%model%outputs)
    length = table_unit("length", variant%model%outputs)
    associate (shaft => variant%found%balance%partial%linkage%shafts(number))
      call append_string(list, "balance shaft "//trim(merge("with   ", "against", &
        shaft%turns > 0))//" the crank at "//to_string(abs(shaft%turns))// &
        " times its speed: mass x radius "//shortest_text(from_si(shaft%first_moment, &
        first_moment))//" "//first_moment%name//", at "//to_string(shaft%phase, 12)// &
        " deg from the x axis where the crank is at 0 deg, axis at "// &
        to_string(from_si(shaft%place(1), length), 12)//", "// &
        to_string(from_si(shaft%place(2), length), 12)//" "//length%name//", mass at radius "// &
        to_string(from_si(shaft%radius, length), 12)//" "//length%name)
    end associate
  end subroutine append_shaft

end module counterweight_notes
