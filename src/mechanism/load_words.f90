!> Loads of processes in words, for heads of tables and the log.
module load_words
  use kinds, only: wp
  use models, only: model_t
  use process_cards, only: over_angle, over_drive, over_measure, over_nothing, over_slider, &
    over_time, over_travel, process_card_t, process_force, process_resistance, process_torque
  use text, only: to_string
  use units, only: coherent_unit, dimension_damping, dimension_length, dimension_line_damping, &
    dimension_velocity, from_si, unit_t
  implicit none (type, external)
  private

  public :: process_words

contains

  !> `load on link rocker: torque 2 N.m, damping 0.5 N.m.s/rad`
  pure function process_words(model, process) result(words)
    type(model_t), intent(in) :: model          !! its units
    type(process_card_t), intent(in) :: process !! of this model
    character(len=:), allocatable :: words

    character(len=:), allocatable :: damper
    type(unit_t) :: measure, damping

    damping = coherent_unit(model%units, dimension_damping)
    measure = model%outputs%moment
    if (.not. process%on_link) damping = coherent_unit(model%units, dimension_line_damping)
    if (.not. process%on_link .or. process%kind == process_force) measure = model%outputs%force
    damper = ""
    select case (process%kind)
    case (process_force)
      words = "force at "//subject_words(process)
      if (process%on_link) words = words//place_words(model, process)
      words = words//": "
      if (process%over /= over_nothing) then
        words = words//"along "//to_string(process%force(1), 12)//" "// &
          to_string(process%force(2), 12)//", "//table_words(process)
      else
        words = words//to_string(from_si(process%force(1), measure), 12)//" "// &
          to_string(from_si(process%force(2), measure), 12)//" "//measure%name
      end if
      if (process%in_link_axes) words = words//" in axes of the link"
    case (process_torque)
      words = "torque on "//subject_words(process)//": "
      if (process%over /= over_nothing) then
        words = words//table_words(process)
      else
        words = words//quantity(process%torque, measure)
      end if
    case (process_resistance)
      words = "load on "//subject_words(process)//":"
      if (abs(process%torque) > 0.0_wp) then
        words = words//" torque "//quantity(process%torque, measure)
        damper = ","
      end if
      if (process%damping > 0.0_wp) then
        words = words//damper//" damping "//quantity(process%damping, damping)
        damper = ","
      end if
      if (process%resisting > 0.0_wp) words = words//damper//" resisting "// &
        quantity(process%resisting, measure)//smooth_words(model, process)
    end select
    if (process%during == 0) return
    words = words//", while it moves "
    if (process%during > 0) words = words//"with it"
    if (process%during < 0) words = words//"against it"
    words = words//smooth_words(model, process)
  end function process_words

  pure function subject_words(process) result(words)
    type(process_card_t), intent(in) :: process
    character(len=:), allocatable :: words

    words = "pin "//process%subject%text
    if (process%on_link) words = "link "//process%subject%text
  end function subject_words

  !> ` (at 120, offset 5 mm)`
  pure function place_words(model, process) result(words)
    type(model_t), intent(in) :: model
    type(process_card_t), intent(in) :: process
    character(len=:), allocatable :: words

    type(unit_t) :: length

    length = coherent_unit(model%units, dimension_length)
    words = " (at "//to_string(from_si(process%place(1), length), 12)
    if (abs(process%place(2)) > 0.0_wp) words = words//", offset "// &
      to_string(from_si(process%place(2), length), 12)
    words = words//" "//length%name//")"
  end function place_words

  !> `table gas.dat over the crank`
  pure function table_words(process) result(words)
    type(process_card_t), intent(in) :: process
    character(len=:), allocatable :: words

    words = "table "//process%table_word%text
    select case (process%over)
    case (over_drive)
      words = words//" over the position of the first drive"
    case (over_slider)
      words = words//" over the place of the block at "//process%over_word%text
    case (over_travel)
      words = words//" over the travel of "//process%over_word%text
    case (over_angle)
      words = words//" over the angle of "//process%over_word%text
    case (over_measure)
      words = words//" over "//process%over_word%text
    case (over_time)
      words = words//" over the time"
    end select
    if (process%is_periodic) words = words//", periodic"
  end function table_words

  !> ` (changes its sign within 1 mm/s)`
  pure function smooth_words(model, process) result(words)
    type(model_t), intent(in) :: model
    type(process_card_t), intent(in) :: process
    character(len=:), allocatable :: words

    type(unit_t) :: measure

    measure = model%outputs%rate
    if (.not. process%on_link .or. process%kind == process_force) measure = &
      coherent_unit(model%units, dimension_velocity)
    words = " (smooth within "//quantity(process%smooth, measure)//")"
  end function smooth_words

  pure function quantity(value, measure) result(words)
    real(wp), intent(in) :: value !! [SI]
    type(unit_t), intent(in) :: measure
    character(len=:), allocatable :: words

    words = to_string(from_si(value, measure), 12)//" "//measure%name
  end function quantity

end module load_words
