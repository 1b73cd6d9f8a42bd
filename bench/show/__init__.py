"""What people see: the terminal, the page and the site."""
