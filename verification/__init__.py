"""Published cases that the service must reproduce; `make verification` writes the table.

Every module holds the cases of related sources. A reference value is a number that its source
prints, or a closed form that its source publishes, evaluated with 30 digits in the module. Nothing
is taken from MDR itself.
"""
